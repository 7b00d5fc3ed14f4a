// SPDX-License-Identifier: MIT
//
// Grows four patterns from Pearson's first state, and compares feedback with copying.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <string_view>
#include <vector>

#include "classics/support/classic.hpp"
#include "reaction.sk.hpp"

namespace {

using classics::larger;
using Field = std::vector<sk::float2>;

constexpr classics::Classic about{
    "reaction", "Harris, Coombe, Scheuermann, Lastra 2002", "cells along a side", 256, 32, 1024};

struct Pattern {
  std::string_view looks;
  float feed, kill;
  std::string_view colours;
};
constexpr std::array<Pattern, 4> patterns = {{{"dividing cells", 0.026f, 0.059f, "lagoon"},
                                              {"holes", 0.030f, 0.055f, "ember"},
                                              {"labyrinths", 0.030f, 0.057f, "ember"},
                                              {"corals", 0.055f, 0.062f, "lagoon"}}};

/// Pearson's units: Du = 2e-5, Dv = 1e-5, a step of 1, and 256 cells over a length of 2.5.
constexpr float dx = 2.5f / 256, spreadU = 2e-5f / (dx * dx), spreadV = 1e-5f / (dx * dx), dt = 1;

constexpr int stepsPerCell =
    32;  ///< of a side: patterns grow at a steady pace, and most of them fill the field

/// U = 1 and V = 0, but for 20 x 20 cells in the middle, where U = 1/2 and V = 1/4 with 1% of noise, which breaks the symmetry.
Field firstState(int n) {
  Field c(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), {1, 0});
  std::mt19937 random(1993);
  const auto noisy = [&](double x) {
    return static_cast<float>(x * (0.99 + 0.02 * random() / 4294967295.0));
  };
  for (int y = n / 2 - 10; y < n / 2 + 10; ++y) {
    for (int x = n / 2 - 10; x < n / 2 + 10; ++x) {
      sk::float2& cell = c[static_cast<std::size_t>(y * n + x)];
      cell.x = noisy(0.5);
      cell.y = noisy(0.25);
    }
  }
  return c;
}

/// The largest difference between `after` and one step from `before` in double.
double errorOfStep(const reaction::Medium& m, int n, const Field& before, const Field& after) {
  const auto index = [n](int y, int x) { return static_cast<std::size_t>((y + n) % n * n + (x + n) % n); };
  const auto u = [&](int y, int x) { return double{before[index(y, x)].x}; };
  const auto v = [&](int y, int x) { return double{before[index(y, x)].y}; };
  double largest = 0;
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const double lapU = u(y, x - 1) + u(y, x + 1) + u(y - 1, x) + u(y + 1, x) - 4 * u(y, x);
      const double lapV = v(y, x - 1) + v(y, x + 1) + v(y - 1, x) + v(y + 1, x) - 4 * v(y, x);
      const double made = u(y, x) * v(y, x) * v(y, x);
      const double nextU = u(y, x) + m.dt * (m.spreadU * lapU - made + m.feed * (1 - u(y, x)));
      const double nextV = v(y, x) + m.dt * (m.spreadV * lapV + made - (double{m.feed} + m.kill) * v(y, x));
      const sk::float2 got = after[index(y, x)];
      largest = larger(larger(largest, std::abs(got.x - nextU)), std::abs(got.y - nextV));
    }
  }
  return largest;
}

void reactions(classics::Run& run) {
  sk::Device& device = run.device();
  const int n = run.size(), steps = stepsPerCell * n;
  const Field first = firstState(n);
  auto c = device.stream<sk::float2>({n, n}), next = device.stream<sk::float2>({n, n});
  auto palette = device.stream<sk::float3>({256});
  constexpr int gap = 8;
  auto picture = device.stream<sk::float3>({2 * n + gap, 2 * n + gap});
  picture.fill({1, 1, 1});
  run.say("Du / dx^2 = {:.3f}: the step of {} is stable, below 2 / (8 Du / dx^2 + F) = {:.2f}", spreadU, dt,
          2 / (8 * spreadU + patterns.back().feed));

  double error = 0, outside = 0;
  int wrongRanges = 0;
  for (int i = 0; i < 4; ++i) {
    const Pattern& p = patterns[static_cast<std::size_t>(i)];
    const reaction::Medium medium{p.feed, p.kill, spreadU, spreadV, dt};
    c.write(first);
    sk::Loop step = device.record([&] { reaction::advance(medium, c, c); });
    const double took = run.timed([&] { step.repeat(steps); });
    run.say("F = {:.3f}, k = {:.3f}: {:17} {} steps in {:.0f} ms, {:.0f} million cells a second", p.feed,
            p.kill, p.looks, steps, took, 1e-3 * steps * n * n / took);

    const Field last = c.read();
    sk::float2 least = last[0], most = last[0];
    for (const sk::float2 cell : last) {
      least = {std::min(least.x, cell.x), std::min(least.y, cell.y)};
      most = {std::max(most.x, cell.x), std::max(most.y, cell.y)};
      for (const float part : {cell.x, cell.y}) outside = larger(outside, std::max(-part, part - 1));
    }
    const auto [low, high] = reaction::range(c);
    wrongRanges += low != least || high != most;
    const int above = i / 2 * (n + gap), left = i % 2 * (n + gap);
    palette.write(examples::colormap(p.colours, 256));
    reaction::paint(palette, high.y, c, picture.domain({above, left}, {above + n, left + n}));
    reaction::advance(medium, c, next);
    error = larger(error, errorOfStep(medium, n, last, next.read()));
  }
  run.picture("reaction.png", examples::imageOf(2 * n + gap, 2 * n + gap, picture.read()));

  const reaction::Medium medium{patterns[0].feed, patterns[0].kill, spreadU, spreadV, dt};
  sk::Loop step = device.record([&] { reaction::advance(medium, c, c); });
  constexpr int some = 200;
  const auto copying = [&] {
    for (int i = 0; i < some; ++i) {
      reaction::advance(medium, c, next);
      next.copyTo(c);
    }
  };
  const auto feedback = [&] {
    for (int i = 0; i < some; ++i) reaction::advance(medium, c, c);
  };
  const auto recorded = [&] { step.repeat(some); };
  run.ratio("200 steps: copying / in place", copying, feedback);
  run.ratio("200 steps in place: called / in a recorded loop", feedback, recorded);

  const auto after = [&](const std::function<void()>& body) {
    c.write(first);
    body();
    return c.read();
  };
  const Field copied = after(copying), fed = after(feedback), looped = after(recorded);
  run.check("one step from each last state", error, 0x1p-21, "8 roundings of numbers up to 1");
  run.check("concentrations outside of [0, 1]", outside, 0x1p-21, "stable steps leave it only by rounding");
  run.check("ranges that are not those of the cells", wrongRanges, 0, "no operation rounds");
  run.check("results of the three ways that differ", (fed != copied) + (looped != copied), 0,
            "the same operations");
}

}  // namespace

int main(int argc, char** argv) { return classics::run(argc, argv, about, reactions); }
