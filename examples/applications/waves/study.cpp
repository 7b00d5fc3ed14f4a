// SPDX-License-Identifier: MIT
#include "study.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "scene.hpp"
#include "support/table.hpp"

namespace waves {

namespace {

Model square(std::int64_t n, double courant) {
  Model m;
  m.width = m.height = n;
  m.spacing = 1.0 / static_cast<double>(n);
  m.timeStep = courant * m.spacing / m.speed;
  m.precision = sk::Precision::Double;
  m.tolerance = 1e-12;
  m.mostIterations = 1000;
  // The one that kernels compute with.
  m.timeStep = std::sqrt(m.lambdaSquared()) * m.spacing / m.speed;
  return m;
}

/// A period and a little more.
std::int64_t stepsFor(const Model& m, const Mode& mode) {
  return std::max<std::int64_t>(
      8, std::llround(1.2 * 2.0 * std::numbers::pi / (schemeOscillation(mode, m).frequency * m.timeStep)));
}

/// Rounding leaves parts of b of a size of `tolerance` in each amplitude, and a second difference of amplitudes is (w dt)^2 times one. The rest is
/// for the steps' residuals adding up.
double frequencyBound(const Model& m, const Oscillation& scheme) {
  const double angle = scheme.frequency * m.timeStep;
  return 8.0 * m.tolerance / (angle * angle);
}

std::string order(double before, double now) {
  return before > 0.0 ? fmt::format("{:.2f}", std::log2(before / now)) : "";
}

const char* nameOf(Scheme scheme) {
  return scheme == Scheme::CrankNicolson ? "Crank-Nicolson" : "backward Euler";
}

}  // namespace

std::vector<double> heightsOf(const Mode& mode, const Model& m) {
  std::vector<double> values;
  for (std::int64_t y = 0; y < m.height; ++y)
    for (std::int64_t x = 0; x < m.width; ++x)
      values.push_back(std::cos(std::numbers::pi * mode.x * (static_cast<double>(x) + 0.5) /
                                static_cast<double>(m.width)) *
                       std::cos(std::numbers::pi * mode.y * (static_cast<double>(y) + 0.5) /
                                static_cast<double>(m.height)));
  return values;
}

double exactFrequency(const Mode& mode, const Model& m) {
  const double kx = mode.x / (static_cast<double>(m.width) * m.spacing),
               ky = mode.y / (static_cast<double>(m.height) * m.spacing);
  return std::numbers::pi * m.speed * std::hypot(kx, ky);
}

Oscillation schemeOscillation(const Mode& mode, const Model& m) {
  const double x = std::sin(0.5 * std::numbers::pi * mode.x / static_cast<double>(m.width)),
               y = std::sin(0.5 * std::numbers::pi * mode.y / static_cast<double>(m.height));
  // u'' = -W^2 u on the grid, and a step takes a part theta of W dt to its end.
  const double angle = std::sqrt(m.lambdaSquared() * 4.0 * (x * x + y * y));
  if (m.scheme == Scheme::CrankNicolson) return {2.0 * std::atan(0.5 * angle) / m.timeStep, 1.0};
  return {std::atan(angle) / m.timeStep, 1.0 / std::sqrt(1.0 + angle * angle)};
}

Measured measure(sk::Device& device, const Model& m, const Mode& mode, std::int64_t steps) {
  Surface surface(device, m);
  const std::vector<double> shape = heightsOf(mode, m);
  surface.writeHeights(shape);
  double norm = 0.0;
  for (const double v : shape) norm += v * v;
  std::vector<double> amplitudes{1.0};
  Measured measured;
  for (std::int64_t i = 0; i < steps; ++i) {
    const Step step = surface.step();
    measured.residual = std::max(measured.residual, step.residual);
    const std::vector<double> u = surface.heights();
    double product = 0.0;
    for (std::size_t k = 0; k < u.size(); ++k) product += u[k] * shape[k];
    amplitudes.push_back(product / norm);
  }
  // Least squares for a(n+1) = p a(n) - s a(n-1).
  double nn = 0.0, nb = 0.0, bb = 0.0, an = 0.0, ab = 0.0;
  for (std::size_t i = 1; i + 1 < amplitudes.size(); ++i) {
    const double before = amplitudes[i - 1], now = amplitudes[i], after = amplitudes[i + 1];
    nn += now * now;
    nb += now * before;
    bb += before * before;
    an += after * now;
    ab += after * before;
  }
  const double determinant = nn * bb - nb * nb;
  const double p = (an * bb - ab * nb) / determinant, s = (an * nb - ab * nn) / determinant;
  measured.oscillation.gain = std::sqrt(s);
  measured.oscillation.frequency = std::acos(std::clamp(0.5 * p / std::sqrt(s), -1.0, 1.0)) / m.timeStep;
  return measured;
}

Findings studyDispersion(sk::Device& device, bool small) {
  Findings findings;
  examples::Table table({"scheme", "half waves", "cells", "Courant number", "frequency", "from the scheme's",
                         "from the wave equation's", "order", "amplitude kept a step"});
  examples::Verification frequencies(
      "frequencies of standing waves against the scheme's, as parts of the bound", 1.0,
      "8 tolerances over (w dt)^2, which is what a second difference loses");
  std::int64_t place = 0;
  double orderFound = 2.0;
  const auto row = [&](Scheme scheme, const Mode& mode, std::int64_t n, double courant, double& before) {
    Model m = square(n, courant);
    m.scheme = scheme;
    const Oscillation exact = schemeOscillation(mode, m);
    const Measured measured = measure(device, m, mode, stepsFor(m, mode));
    const double off = std::abs(measured.oscillation.frequency / exact.frequency - 1.0);
    const double error = std::abs(measured.oscillation.frequency / exactFrequency(mode, m) - 1.0);
    frequencies.note(place++, off / frequencyBound(m, exact));
    frequencies.note(place++, std::abs(measured.oscillation.gain - exact.gain) / frequencyBound(m, exact));
    table.add({nameOf(scheme), fmt::format("{} x {}", mode.x, mode.y), fmt::format("{0} x {0}", n),
               fmt::format("{:g}", courant), fmt::format("{:.6f}", measured.oscillation.frequency),
               fmt::format("{:.1e}", off), fmt::format("{:.2e}", error), order(before, error),
               fmt::format("{:.6f}", measured.oscillation.gain)});
    if (before > 0.0 && scheme == Scheme::CrankNicolson) orderFound = std::log2(before / error);
    before = error;
  };
  const std::int64_t finest = small ? 32 : 64;
  for (const Scheme scheme : {Scheme::CrankNicolson, Scheme::BackwardEuler})
    for (const Mode& mode : {Mode{1, 0}, Mode{3, 2}}) {
      double before = 0.0;
      for (std::int64_t n = 16; n <= finest; n *= 2) row(scheme, mode, n, 0.5, before);
    }
  for (const double courant : {1.0, 2.0, 4.0, 8.0}) {
    double before = 0.0;
    row(Scheme::CrankNicolson, {3, 2}, small ? 32 : 64, courant, before);
  }
  examples::Verification orders("order of Crank-Nicolson's frequencies, from 2", 0.05,
                                "the scheme is of second order in space and time");
  orders.note(0, std::abs(orderFound - 2.0));
  findings.table = table.markdown();
  findings.verifications = {frequencies, orders};
  return findings;
}

Findings studyEnergy(sk::Device& device, bool small) {
  Findings findings;
  const std::int64_t most = small ? 1000 : 100000;
  std::vector<std::string> heads = {"scheme", "precision", "tolerance", "iterations a step",
                                    "largest residual"};
  for (std::int64_t n = 100; n <= most; n *= 10) heads.push_back(fmt::format("change after {} steps", n));
  heads.emplace_back("bound");
  examples::Table table(heads);
  struct Row {
    Scheme scheme;
    sk::Precision precision;
    double tolerance;
  };
  const Row rows[] = {{Scheme::CrankNicolson, sk::Precision::Double, 1e-12},
                      {Scheme::CrankNicolson, sk::Precision::Single, 1e-6},
                      {Scheme::CrankNicolson, sk::Precision::Single, 1e-4},
                      {Scheme::BackwardEuler, sk::Precision::Double, 1e-12}};
  examples::Verification drifts(
      "change of the energy by Crank-Nicolson, as a part of the bound", 1.0,
      "8 Courant numbers times the residual over the energy's root, summed over all steps");
  std::int64_t place = 0;
  for (const Row& row : rows) {
    Model m;
    m.width = 24;
    m.height = 16;
    m.spacing = 1.0 / 24.0;
    m.timeStep = m.spacing;
    m.scheme = row.scheme;
    m.precision = row.precision;
    m.tolerance = row.tolerance;
    Surface surface(device, m);
    std::vector<double> heights(static_cast<std::size_t>(m.width * m.height), 0.0);
    add({.x = 0.3, .y = 0.25, .radius = 0.12, .depth = 0.05}, m, heights);
    surface.writeHeights(heights);
    const double start = surface.energy();
    double bound = 0.0, residual = 0.0, iterations = 0.0;
    std::vector<std::string> changes;
    for (std::int64_t i = 1, next = 100; i <= most; ++i) {
      const Step step = surface.step();
      bound += surface.energyBound(step, start);
      residual = std::max(residual, step.residual);
      iterations += static_cast<double>(step.iterations);
      if (i < next) continue;
      changes.push_back(fmt::format("{:+.1e}", surface.energy() / start - 1.0));
      next *= 10;
    }
    const bool conserves = row.scheme == Scheme::CrankNicolson;
    if (conserves) drifts.note(place++, std::abs(surface.energy() - start) / bound);
    std::vector<std::string> cells = {
        nameOf(row.scheme), row.precision == sk::Precision::Double ? "double" : "single",
        fmt::format("{:.0e}", row.tolerance), fmt::format("{:.1f}", iterations / static_cast<double>(most)),
        fmt::format("{:.1e}", residual)};
    cells.insert(cells.end(), changes.begin(), changes.end());
    cells.push_back(conserves ? fmt::format("{:.1e}", bound / start) : "");
    table.add(cells);
  }
  findings.table = table.markdown();
  findings.verifications = {drifts};
  return findings;
}

}  // namespace waves
