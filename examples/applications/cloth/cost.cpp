// SPDX-License-Identifier: MIT
#include "cost.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "support/stopwatch.hpp"
#include "support/table.hpp"

namespace examples {
namespace {

/// Milliseconds of a step.
double timeOf(sk::Device& device, Simulation& simulation, std::int64_t steps) {
  return millisecondsOf(device, [&] { simulation.advance(steps); }) / static_cast<double>(steps);
}

void count(sk::Device& device, Simulation& simulation, Cost& cost) {
  constexpr int steps = 4;
  const sk::PassCount passes = passesOf(device, [&] { simulation.advance(steps); });
  cost.streams = simulation.streams();
  cost.passes = static_cast<double>(passes.passes) / steps;
  cost.bytes = static_cast<double>(passes.bytesRead + passes.bytesWritten) / steps;
}

std::string namesOf(const LinkKinds& kinds) {
  std::vector<const char*> names;
  if (kinds.structural) names.push_back("structural");
  if (kinds.shear) names.push_back("shear");
  if (kinds.bend) names.push_back("bend");
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string bytesText(double bytes) {
  return bytes >= 1e6 ? fmt::format("{:.2f} MB", bytes / 1e6) : fmt::format("{:.1f} kB", bytes / 1e3);
}

}  // namespace

Comparison compareWithFull(sk::Device& device, const Scene& scene, sk::Precision precision,
                           const State& state) {
  Comparison result;
  Simulation required(device, scene, Features::of(scene), precision);
  Simulation full(device, scene, Features::full(scene), precision);
  required.restore(state);
  full.restore(state);
  count(device, required, result.required);
  count(device, full, result.full);
  required.finish();
  full.finish();

  // Rounds of some milliseconds each, so that the clock and the caches do not decide.
  const double first = std::max(1e-3, timeOf(device, required, 4));
  timeOf(device, full, 4);
  const auto steps = std::clamp<std::int64_t>(static_cast<std::int64_t>(8.0 / first), 2, 50);
  std::vector<double> requiredTimes, fullTimes;
  for (int round = 0; round < 9; ++round) {
    requiredTimes.push_back(timeOf(device, required, steps));
    fullTimes.push_back(timeOf(device, full, steps));
  }
  result.required.milliseconds = median(requiredTimes);
  result.full.milliseconds = median(fullTimes);
  result.steps = required.step() - state.step;
  const std::vector<double> a = required.positions(), b = full.positions();
  for (std::size_t i = 0; i < a.size(); ++i) {
    // What is NaN in both is no difference; `!(<=)` lets a NaN in one of them through.
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= result.deviation) && !(std::isnan(a[i]) && std::isnan(b[i])))
      result.deviation = difference;
  }
  return result;
}

std::string partsOf(const Scene& scene) {
  const Features f = Features::of(scene);
  std::vector<std::string> parts;
  if (f.springs.any()) parts.push_back("springs: " + namesOf(f.springs));
  if (f.relaxed.any()) {
    parts.push_back(fmt::format("constraints: {}, {} round{}", namesOf(f.relaxed), scene.links.iterations,
                                scene.links.iterations == 1 ? "" : "s"));
  }
  if (f.tearing) parts.push_back("tearing");
  if (f.windy) parts.push_back("wind");
  if (f.carried) parts.push_back("pins that move");
  const auto bodies = [&](Kind kind, const char* one, const char* many) {
    const auto n = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                 [&](const Body& b) { return b.kind == kind; });
    if (n > 0) parts.push_back(fmt::format("{} {}", n, n == 1 ? one : many));
  };
  bodies(Kind::Sphere, "sphere", "spheres");
  bodies(Kind::Plane, "plane", "planes");
  bodies(Kind::Capsule, "capsule", "capsules");
  bodies(Kind::Box, "box", "boxes");
  return parts.empty() ? "nothing but inertia and gravity" : fmt::format("{}", fmt::join(parts, "; "));
}

std::string tableOf(const Comparison& c, const Scene& scene) {
  Table table({"a step", "the scene's model", "the full model", "ratio"});
  const auto row = [&](const char* name, double required, double full, const std::string& a,
                       const std::string& b) {
    table.add({name, a, b, fmt::format("{:.2f}", full / std::max(required, 1e-12))});
  };
  const Cost& r = c.required;
  const Cost& f = c.full;
  row("streams", r.streams, f.streams, fmt::format("{}", r.streams), fmt::format("{}", f.streams));
  row("passes", r.passes, f.passes, fmt::format("{:.4g}", r.passes), fmt::format("{:.4g}", f.passes));
  row("bytes", r.bytes, f.bytes, bytesText(r.bytes), bytesText(f.bytes));
  row("ms", r.milliseconds, f.milliseconds, fmt::format("{:.3g}", r.milliseconds),
      fmt::format("{:.3g}", f.milliseconds));
  return fmt::format("required: {}\n{}largest difference of both after {} steps: {:.3g} m\n", partsOf(scene),
                     table.text(), c.steps, c.deviation);
}

}  // namespace examples
