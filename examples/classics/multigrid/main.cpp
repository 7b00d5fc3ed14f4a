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
using classics::larger, classics::largestOf;
using Grid = MultigridStreams;
using Reals = std::vector<double>;
constexpr double roundoff = 0x1p-24, dt = 0.02;

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

/// Number `part` of the elements `a` at (x, y), in double: linear between n x n elements, and constant beyond the ends.
double sampled(int n, const Reals& a, int part, double x, double y) {
  const int parts = static_cast<int>(a.size()) / n / n;
  const auto end = [&](double i) { return std::clamp<int>(i, 0, n - 1); };
  const auto at = [&](double i, double j) { return a[(end(j) * n + end(i)) * parts + part]; };
  const double i = std::floor(x), j = std::floor(y), s = x - i, t = y - j;
  return (1 - t) * std::lerp(at(i, j), at(i + 1, j), s) + t * std::lerp(at(i, j + 1), at(i + 1, j + 1), s);
}

/// f - A u in double, for m x m elements.
Reals residualOf(int m, const Reals& u, const Reals& f) {
  const auto at = [&](int y, int x) { return x < 0 || y < 0 || x == m || y == m ? 0 : u[y * m + x]; };
  Reals r = f;
  for (int k = 0, x = 0, y = 0; k < m * m; ++k, x = k % m, y = k / m)
    r[k] += (m + 1.0) * (m + 1) * (at(y, x - 1) + at(y, x + 1) + at(y - 1, x) + at(y + 1, x) - 4 * u[k]);
  return r;
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
    double excess = 0, wrong = 0;  // of factors, and after advect
    for (const Sweeps& s : {Sweeps{1, 1, 0.8F}, Sweeps{2, 1, 0.8F}, Sweeps{2, 2, 0.8F}, Sweeps{1, 1, 1}}) {
      const double theory = twoGrids.over(device, {64, 64})(s.omega, s.before + s.after);
      const Reals found = {measured(device, n / 4, s), measured(device, n / 2, s), measured(device, n, s)};
      run.say("  V({},{}) with omega {:.1f}: {:.3f}; {:.3f}", s.before, s.after, s.omega, theory,
              fmt::join(found, ", "));
      if (s.omega < 1) excess = larger(excess, largestOf(found) - theory);
    }
    run.check("damped cycles, over theory", excess, 0.05, "coarse problems are solved by one cycle only");
    constexpr Sweeps sweeps = {2, 2, 0.8F};
    std::vector<Grid> grids = gridsOf(device, n);
    auto& [u, f, r] = grids[0];
    auto w = device.stream<sk::float2>({n, n});
    auto heat = device.stream<float>({n, n});
    const auto cycle = [&] { vcycle(grids, sweeps); };
    sk::Loop flow = device.record([&] {
      advect(dt, w, heat, w, heat);
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
    sk::Loop recorded = device.record(cycle);
    u.fill(0), recorded.repeat(16);
    const Reals best = u.readReals();
    const double size = largestOf(best), scale = 8.0 * n * n * size + largestOf(b);
    run.check("f - A u after 16 cycles, over |A| |u| + |f|", largestOf(residualOf(n - 1, best, b)) / scale,
              8 * roundoff, "8 roundings of u");
    run.ratio("20 cycles, called / recorded", [&] { repeat(20, cycle); }, [&] { recorded.repeat(20); });
    u.fill(0);
    for (int k = 0; k < 4; ++k) {
      std::vector<float> e = u.read();
      for (std::size_t i = 0; i < e.size(); ++i) e[i] = std::log10(std::abs(e[i] - best[i]) / size);
      errors.push_back(classics::fieldPicture(e, n - 1, n - 1, -4, 0, "ember", std::max(1, 256 / n)));
      cycle();
    }
    run.picture("multigrid_error.png", classics::sideBySide(errors));
    const Reals w0 = w.readReals(), heat0 = heat.readReals();
    advect(dt, w, heat, w, heat);
    const Reals w1 = w.readReals(), heat1 = heat.readReals();
    for (int k = 0; k < n * n; ++k) {
      const auto carried = [&](const Reals& a, int part, double dx,
                               double dy) {  // to element k, less (dx, dy)
        const double x = k % n - dx, y = k / n - dy;
        const double fromX = x - dt * n * sampled(n, w0, 0, x + 0.5, y);
        return sampled(n, a, part, fromX + dx, y - dt * n * sampled(n, w0, 1, x, y + 0.5) + dy);
      };
      wrong = larger(wrong, std::abs(w1[2 * k] - carried(w0, 0, 0.5, 0)));
      wrong = larger(wrong, std::abs(w1[2 * k + 1] + dt * heat1[k] - carried(w0, 1, 0, 0.5)));
      if (std::abs(heat1[k]) < 1) wrong = larger(wrong, std::abs(heat1[k] - carried(heat0, 0, 0, 0)));
    }
    run.check("w and heat after advect", wrong, 4 * roundoff * n, "4 roundings of positions up to n");
  });
}
