// SPDX-License-Identifier: MIT
//
// A unit sphere shrinks until the time 0.1, when its radius is sqrt(0.6): convergence in space and time together, in time alone, and in space alone.
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "flow.hpp"
#include "study.hpp"
#include "support/table.hpp"

namespace smooth {

namespace {

constexpr double endTime = 0.1;
const double exactRadius = std::sqrt(1.0 - 4.0 * endTime);

struct Radii {
  std::size_t vertices = 0;
  double mean = 0.0;
  double largestError = 0.0;  ///< of a vertex
  double spread = 0.0;  ///< the largest radius less the smallest one
};

Radii radiiAfter(sk::Device& device, int level, int steps) {
  Flow flow(device, sphere(level, 1.0), {.timeStep = endTime / steps, .layout = "rows"});
  for (int i = 0; i < steps; ++i) flow.step();
  Radii radii{.vertices = flow.surface().points.size()};
  double least = 1.0, most = 0.0;
  for (const Vector& p : flow.surface().points) {
    radii.mean += length(p) / static_cast<double>(radii.vertices);
    radii.largestError = std::max(radii.largestError, std::abs(length(p) - exactRadius));
    least = std::min(least, length(p));
    most = std::max(most, length(p));
  }
  radii.spread = most - least;
  return radii;
}

/// The order that two errors show between which an edge or a time step has been halved; "" for the first row.
std::string orderText(double before, double now) {
  return before == 0.0 ? "" : fmt::format("{:.2f}", std::log2(before / now));
}

std::string together(sk::Device& device, bool small, examples::Verification& order) {
  examples::Table table({"level", "vertices", "steps", "time step", "mean radius", "its error", "order",
                         "largest error of a vertex", "order"});
  double meanBefore = 0.0, largestBefore = 0.0;
  for (int level = 1, steps = 4; level <= (small ? 2 : 4); ++level, steps *= 4) {
    const Radii radii = radiiAfter(device, level, steps);
    const double error = std::abs(radii.mean - exactRadius);
    table.add({fmt::format("{}", level), fmt::format("{}", radii.vertices), fmt::format("{}", steps),
               fmt::format("{:.4g}", endTime / steps), fmt::format("{:.6f}", radii.mean),
               fmt::format("{:.2e}", error), orderText(meanBefore, error),
               fmt::format("{:.2e}", radii.largestError), orderText(largestBefore, radii.largestError)});
    if (meanBefore > 0.0) order.note(level, std::abs(std::log2(meanBefore / error) - 2.0));
    meanBefore = error;
    largestBefore = radii.largestError;
  }
  return table.markdown();
}

std::string inTime(sk::Device& device, bool small, examples::Verification& order) {
  const int level = small ? 1 : 3, fewest = small ? 8 : 4, most = small ? 32 : 64;
  // The limit of short steps, extrapolated from the last two of them, of which the shorter one is not a row.
  const double halved = radiiAfter(device, level, 2 * most).mean;
  const double limit = 2.0 * halved - radiiAfter(device, level, most).mean;
  examples::Table table({"steps", "time step", "mean radius", "difference", "order"});
  double before = 0.0;
  for (int steps = fewest; steps < most; steps *= 2) {
    const double mean = radiiAfter(device, level, steps).mean, difference = std::abs(mean - limit);
    table.add({fmt::format("{}", steps), fmt::format("{:.4g}", endTime / steps), fmt::format("{:.6f}", mean),
               fmt::format("{:.2e}", difference), orderText(before, difference)});
    if (before > 0.0) order.note(steps, std::abs(std::log2(before / difference) - 1.0));
    before = difference;
  }
  return table.markdown();
}

std::string inSpace(sk::Device& device, bool small, examples::Verification& order) {
  const int steps = small ? 8 : 32;
  examples::Table table({"level", "vertices", "largest less smallest radius", "order"});
  double before = 0.0;
  for (int level = 1; level <= (small ? 2 : 4); ++level) {
    const Radii radii = radiiAfter(device, level, steps);
    table.add({fmt::format("{}", level), fmt::format("{}", radii.vertices),
               fmt::format("{:.2e}", radii.spread), orderText(before, radii.spread)});
    if (before > 0.0) order.note(level, std::max(0.0, 2.0 - std::log2(before / radii.spread)));
    before = radii.spread;
  }
  return table.markdown();
}

}  // namespace

Findings studySphere(sk::Device& device, bool small) {
  examples::Verification both("order of the mean radius' error, from 2", 0.25,
                              "time steps are quartered, and the mean radius has hardly an error in space");
  examples::Verification time("order in time, from 1", 0.25, "implicit Euler");
  // Measured, not derived: the order rises towards 2 with the level.
  examples::Verification space("order of the spread of radii, below 2", 0.75,
                               "twelve vertices have five triangles, all others six");
  const std::string tables = together(device, small, both) + "\n" + inTime(device, small, time) + "\n" +
                             inSpace(device, small, space);
  return {tables, {both, time, space}};
}

}  // namespace smooth
