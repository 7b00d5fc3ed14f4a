// SPDX-License-Identifier: MIT
#include "checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "support/progress.hpp"

namespace examples {

Means meansOf(std::span<const sk::float2> state) {
  Means sum{0.0, 0.0};
  for (const sk::float2& c : state) {
    sum.u += c.x;
    sum.v += c.y;
  }
  const auto count = static_cast<double>(state.size());
  return {sum.u / count, sum.v / count};
}

Verification checkSteps(int size, int steps, const Parameters& p, std::span<const sk::float2> first,
                        std::span<const sk::float2> device) {
  HostField<double> exact(size, first);
  HostField<float> rounded(size, first);
  Progress progress("checking", steps);
  for (int step = 0; step < steps; ++step) {
    exact.advance(p);
    rounded.advance(p);
    progress.update(step + 1);
  }
  double hostError = 0.0;
  for (std::size_t i = 0; i < device.size(); ++i) {
    hostError = std::max(
        {hostError, std::abs(rounded.u()[i] - exact.u()[i]), std::abs(rounded.v()[i] - exact.v()[i])});
  }
  Verification verification(fmt::format("u and v after {} steps against double loops", steps),
                            8.0 * hostError + 4.0 * roundoff,
                            fmt::format("8 times what float loops on the CPU are off, {:.2g}", hostError));
  for (std::size_t i = 0; i < device.size(); ++i) {
    const auto place = static_cast<std::int64_t>(i);
    verification.compare(place, device[i].x, exact.u()[i]);
    verification.compare(place, device[i].y, exact.v()[i]);
  }
  return verification;
}

Verification checkBalance(const Parameters& p, std::span<const sk::float2> before,
                          std::span<const sk::float2> after) {
  const double feed = p.feed, kill = p.kill, dt = p.dt;
  const Means was = meansOf(before);
  const Means is = meansOf(after);
  const double fed = dt * (feed * (1.0 - was.u) - (feed + kill) * was.v);
  Verification verification(fmt::format("balance of u + v in the last step, a change of {:.3g}", fed),
                            8.0 * roundoff, "the roundings of u and v in one step, all to one side");
  verification.compare(0, (is.u - was.u) + (is.v - was.v), fed);
  return verification;
}

Verification checkMeans(std::span<const sk::float2> state, sk::float2 deviceSum) {
  const Means means = meansOf(state);
  const auto count = static_cast<std::int64_t>(state.size());
  Verification verification("means of u and v by reduce, relative", sumBound(count),
                            "the roundings of the sum");
  verification.compare(0, deviceSum.x / static_cast<double>(count), means.u, means.u);
  verification.compare(1, deviceSum.y / static_cast<double>(count), means.v, means.v);
  return verification;
}

}  // namespace examples
