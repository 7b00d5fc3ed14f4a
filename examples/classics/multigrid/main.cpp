// SPDX-License-Identifier: MIT
//
// The multigrid of Bolz, Farmer, Grinspun and Schroeder 2003: multigrid.sk has the paper, and the kernels.
#include <algorithm>
#include <cmath>
#include <span>

#include "classics/support/classic.hpp"
#include "multigrid.sk.hpp"

namespace {

using namespace multigrid;
using classics::largestOf;
using Grid = MultigridStreams;
using Reals = std::vector<double>;
constexpr double roundoff = 0x1p-24;

struct Sweeps {
  int before, after;
  float omega;
};

void repeat(int times, const auto& body) {
  for (; times > 0; --times) body();
}

/// A grid of n cells along a side, and all coarser ones.
std::vector<Grid> gridsOf(sk::Device& device, int n) {
  std::vector<Grid> grids;
  for (; n > 1; n = n % 2 == 0 ? n / 2 : 0) grids.emplace_back(device, n - 1);
  return grids;
}

void vcycle(std::span<Grid> grids, const Sweeps& sweeps) {
  Grid& fine = grids[0];
  const auto relax = [&] { smooth(sweeps.omega, fine.f, fine.u, fine.u); };
  if (grids.size() == 1) return repeat(10, relax);  // 2 or 3 cells: all but solves
  repeat(sweeps.before, relax);
  residual(fine.f, fine.u, fine.r);
  restrict(fine.r, grids[1].f);
  grids[1].u.fill(0);
  vcycle(grids.subspan(1), sweeps);
  correct(grids[1].u, fine.u, fine.u);
  repeat(sweeps.after, relax);
}

/// By how much a cycle multiplies an error of all frequencies: the mean of ten cycles, after ten others.
double measured(sk::Device& device, int n, const Sweeps& sweeps) {
  std::vector<Grid> grids = gridsOf(device, n);
  sk::Loop cycle = device.record([&] { vcycle(grids, sweeps); });
  disturb(grids[0].u), grids[0].f.fill(0);
  cycle.repeat(10);
  const double before = largest(grids[0].u);
  cycle.repeat(10);
  return std::pow(largest(grids[0].u) / before, 0.1);
}

/// f - A u in double, for m x m elements.
Reals residualOf(int m, const Reals& u, const Reals& f) {
  const auto at = [&](int y, int x) { return x < 0 || y < 0 || x == m || y == m ? 0 : u[y * m + x]; };
  Reals r = f;
  for (int k = 0, x = 0, y = 0; k < m * m; ++k, x = k % m, y = k / m)
    r[k] += (m + 1.0) * (m + 1) * (at(y, x - 1) + at(y, x + 1) + at(y - 1, x) + at(y + 1, x) - 4 * u[k]);
  return r;
}

/// A V-cycle in double.
Reals vcycleOf(int m, Reals u, const Reals& f, const Sweeps& sweeps) {
  const auto relax = [&] {
    const Reals r = residualOf(m, u, f);
    for (int k = 0; k < m * m; ++k) u[k] += 0.25 * sweeps.omega / (m + 1) / (m + 1) * r[k];
  };
  if (m < 3) return repeat(10, relax), u;
  repeat(sweeps.before, relax);
  const int n = (m - 1) / 2;  // of the coarse grid
  const auto transfer =
      [&](const auto& body) {  // each coarse element with the nine around it, and their weights
        constexpr double weights[] = {0.25, 0.5, 0.25, 0.5, 1, 0.5, 0.25, 0.5, 0.25};
        for (int k = 0; k < n * n; ++k)
          for (int i = 0; i < 9; ++i) body(k, (k / n * 2 + i / 3) * m + k % n * 2 + i % 3, weights[i]);
      };
  Reals coarse(n * n);
  const Reals r = residualOf(m, u, f);
  transfer([&](int k, int fine, double weight) { coarse[k] += weight / 4 * r[fine]; });
  coarse = vcycleOf(n, Reals(n * n), coarse, sweeps);
  transfer([&](int k, int fine, double weight) { u[fine] += weight * coarse[k]; });
  repeat(sweeps.after, relax);
  return u;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr classics::Classic about{
      "multigrid", "Bolz, Farmer, Grinspun, Schroeder 2003", "cells along a side", 256, 32, 1024};
  return classics::run(argc, argv, about, [](classics::Run& run) {
    sk::Device& device = run.device();
    int n = 2;
    while (n < run.size()) n = n % 3 == 0 ? n / 3 * 4 : n / 2 * 3;  // 2, 3, 4, 6, 8, 12 ...
    run.say("factor of an error in a cycle: two-grid theory; {}, {}, {} cells along a side", n / 4, n / 2, n);
    for (const Sweeps& s : {Sweeps{1, 1, 0.8F}, Sweeps{2, 1, 0.8F}, Sweeps{2, 2, 0.8F}, Sweeps{1, 1, 1}})
      run.say("  V({},{}) with omega {:.1f}: {:.3f}; {:.3f}, {:.3f}, {:.3f}", s.before, s.after, s.omega,
              twoGrids.over(device, {64, 64})(s.omega, s.before + s.after), measured(device, n / 4, s),
              measured(device, n / 2, s), measured(device, n, s));
    constexpr Sweeps sweeps = {2, 2, 0.8F};
    std::vector<Grid> grids = gridsOf(device, n);
    auto& [u, f, r] = grids[0];
    auto w = device.stream<sk::float2>({n, n});
    auto heat = device.stream<float>({n, n});
    const auto cycle = [&] { vcycle(grids, sweeps); };
    sk::Loop flow = device.record([&] {
      advect(0.02F, w, heat, w, heat);
      diverge(w, f);
      cycle(), cycle();
      project(u, w, w);
    });
    w.fill({0, 0}), heat.fill(0), u.fill(0), flow.repeat(1);  // compiles the programs
    std::vector<examples::Image> images, errors;
    for (int k = 0; k < 3; ++k) {
      run.timed([&] { flow.repeat(40); });
      images.push_back(classics::fieldPicture(heat.read(), n, n, -1, 1, "dusk", std::max(1, 256 / n)));
    }
    run.picture("multigrid.png", classics::sideBySide(images));
    diverge(w, r);
    const Reals b = f.readReals(), left = residualOf(n - 1, u.readReals(), b);
    run.check("divergence of w, the residual", classics::largestDifference(r.read(), left),
              16 * roundoff * n * largestOf(w.readReals()), "16 roundings of n w");
    u.fill(0), cycle();
    const Reals expected = vcycleOf(n - 1, Reals(b.size()), b, sweeps);
    run.check("u after one cycle", classics::largestDifference(u.read(), expected),
              32 * roundoff * largestOf(expected), "16 roundings, and those of coarse grids");
    sk::Loop recorded = device.record(cycle);
    recorded.repeat(15);
    const Reals best = u.readReals();
    const double size = largestOf(best), scale = 8.0 * n * n * size + largestOf(b);
    run.check("f - A u after 16 cycles, over |A| |u| + |f|", largestOf(residualOf(n - 1, best, b)) / scale,
              8 * roundoff, "8 roundings of u");
    const auto called = [&] { repeat(20, cycle); };
    run.ratio("20 cycles: call by call, against a recorded loop", called, [&] { recorded.repeat(20); });
    u.fill(0);
    for (int k = 0; k < 4; ++k) {
      std::vector<float> e = u.read();
      for (std::size_t i = 0; i < e.size(); ++i) e[i] = std::log10(std::abs(e[i] - best[i]) / size);
      errors.push_back(classics::fieldPicture(e, n - 1, n - 1, -4, 0, "ember", std::max(1, 256 / n)));
      cycle();
    }
    run.picture("multigrid_error.png", classics::sideBySide(errors));
  });
}
