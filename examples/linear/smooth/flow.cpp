// SPDX-License-Identifier: MIT
#include "flow.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "layout.hpp"
#include "named.hpp"
#include "solve.hpp"

namespace smooth {

Equations equationsOf(const Surface& s, const Faults& faults, const FlowSettings& settings) {
  const auto n = static_cast<std::int64_t>(s.points.size());
  std::vector<bool> stays(s.points.size(), false);
  if (settings.fixesBoundary) stays = faults.boundary;
  for (const std::int32_t i : faults.isolated) stays[static_cast<std::size_t>(i)] = true;

  std::vector<double> mass(s.points.size(), 0.0);
  std::vector<linear::Entry> laplacian;
  double total = 0.0;
  auto degenerate = faults.degenerate.begin();
  for (std::size_t f = 0; f < s.faces.size(); ++f) {
    if (degenerate != faults.degenerate.end() && *degenerate == static_cast<std::int64_t>(f)) {
      ++degenerate;
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t at = s.faces[f][k], i = s.faces[f][(k + 1) % 3], j = s.faces[f][(k + 2) % 3];
      const Vector corner = s.points[static_cast<std::size_t>(at)];
      const Vector a = s.points[static_cast<std::size_t>(i)] - corner,
                   b = s.points[static_cast<std::size_t>(j)] - corner;
      const double twiceArea = length(cross(a, b));
      mass[static_cast<std::size_t>(at)] += twiceArea / 6.0;
      total += twiceArea / 6.0;
      // The edge from i to j is opposite of this corner.
      const double weight = settings.timeStep * dot(a, b) / twiceArea / 2.0;
      for (const auto& [row, column] : {std::pair{i, j}, std::pair{j, i}}) {
        if (stays[static_cast<std::size_t>(row)]) continue;
        laplacian.push_back({row, row, weight});
        laplacian.push_back({row, column, -weight});
      }
    }
  }
  std::vector<linear::Entry> sum;
  for (const linear::Entry& e : laplacian)
    if (!stays[static_cast<std::size_t>(e.column)]) sum.push_back(e);  // its change is 0
  const double mean = total / static_cast<double>(std::max<std::int64_t>(n, 1));
  for (std::int64_t i = 0; i < n; ++i)
    sum.push_back({i, i, stays[static_cast<std::size_t>(i)] ? mean : mass[static_cast<std::size_t>(i)]});
  return {linear::assemble(n, n, sum), linear::assemble(n, n, laplacian)};
}

Flow::Flow(sk::Device& device, Surface surface, const FlowSettings& settings)
    : device_(device),
      surface_(std::move(surface)),
      settings_(settings),
      faults_(inspect(surface_)),
      layout_(settings.layout),
      volume_(volumeOf(surface_)) {
  if (faults_.degenerate.size() == surface_.faces.size())
    throw std::runtime_error("the surface has no triangle with an area; nothing can flow");
  if (settings_.keepsVolume && (!faults_.isClosed || !(std::abs(volume_) > 0.0)))
    throw std::runtime_error(
        "the surface is open, or encloses nothing, and has no volume to keep; take keep_volume = false");
}

StepReport Flow::step() {
  ++steps_;
  const Equations equations = equationsOf(surface_, faults_, settings_);
  const linear::Operator a = linear::operatorOf(equations.matrix);
  const linear::Arithmetic arithmetic;
  const auto matrix =
      linear::makeMatrix(device_, linear::scaled(equations.matrix, a.scale), layout_, arithmetic);
  layout_ = matrix->layout();
  const auto preconditioner = linear::rowNamed(linear::preconditionerKinds(), "jacobi", "preconditioner")
                                  .make(device_, *matrix, a, arithmetic);
  const auto method = linear::rowNamed(linear::methodKinds(), "cg", "solver")
                          .make(device_, *matrix, preconditioner.get(), arithmetic);
  StepReport report;
  for (double Vector::*const component : {&Vector::x, &Vector::y, &Vector::z}) {
    std::vector<double> x;
    for (const Vector& p : surface_.points) x.push_back(p.*component);
    // For the change of x, so that the tolerance is that of the change.
    std::vector<double> b = linear::multiply(equations.laplacian, x);
    for (double& v : b) v = -v;
    const linear::Solution change =
        linear::solve(*method, a, b, arithmetic, {.tolerance = settings_.tolerance});
    if (change.outcome != linear::Outcome::Converged)
      throw std::runtime_error(
          fmt::format("step {}: the equations were not solved: {}, residual {:.2g}; take a smaller time step",
                      steps_, linear::nameOf(change.outcome), change.residualTrue));
    for (std::size_t i = 0; i < x.size(); ++i) surface_.points[i].*component += change.x[i];
    report.iterations += change.iterations;
    report.residual = std::max(report.residual, change.residualTrue);
    report.secondsSolving += change.seconds;
  }
  inspectAreas(surface_, faults_);
  if (settings_.keepsVolume) restoreVolume();
  report.volume = volumeOf(surface_);
  report.area = areaOf(surface_);
  return report;
}

void Flow::restoreVolume() {
  const double factor = std::cbrt(volume_ / volumeOf(surface_));
  const Vector centre = centreOf(surface_);
  for (Vector& p : surface_.points) p = centre + factor * (p - centre);
}

}  // namespace smooth
