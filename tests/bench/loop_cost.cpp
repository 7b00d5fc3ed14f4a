// SPDX-License-Identifier: MIT
#include "loop_cost.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench.sk.hpp"
#include "rounds.hpp"
#include "side_by_side.hpp"

namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

/// Microseconds for each iteration of a loop that has run before.
std::vector<double> timesOf(sk::Device& device, sk::Loop& loop, int rounds) {
  constexpr int times = 1000;
  loop.repeat(50);
  std::vector<double> microseconds;
  for (int round = 0; round < rounds; ++round) {
    device.finish();
    const auto start = Clock::now();
    loop.repeat(times);
    microseconds.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count() / times);
  }
  device.finish();
  return microseconds;
}

/// Square streams and a scalar.
struct Arrays {
  Arrays(sk::Device& device, int side)
      : x(device.stream<float>({side, side})),
        y(device.stream<float>({side, side})),
        r(device.stream<float>({side, side})),
        total(device.scalar<float>(0)) {
    for (sk::Stream<float>* stream : {&x, &y, &r}) stream->write(ramp(std::int64_t{side} * side, 0.37f));
  }
  sk::Stream<float> x, y, r;
  sk::Scalar<float> total;
};

void loopCostsOf(sk::Device& device, int side, std::optional<double> limit, int rounds, Report& report) {
  const auto add = [&](const std::string& what, std::optional<double> bar, auto&& body) {
    Arrays arrays(device, side);
    sk::Loop loop = device.record([&] { body(arrays); });
    report.add({fmt::format("{} on '{}', {} x {}, host", what, device.profile(), side, side),
                "us",
                quartilesOf(timesOf(device, loop, rounds)),
                bar,
                {}});
  };
  add("a repeated call", limit, [](Arrays& a) { saxpy(2.5f, a.x, a.y, a.r); });
  add("a repeated stencil and swap", {}, [](Arrays& a) {
    binomial(a.x, a.r);
    std::swap(a.x, a.r);
  });
  add("a repeated stencil in place", {}, [](Arrays& a) { binomial(a.x, a.x); });
  add("a repeated sum to a scalar", {}, [](Arrays& a) { sum(a.x, a.total); });
  add("a repeated operation with a scalar", {}, [](Arrays& a) { a.total *= 0.5f; });
}

}  // namespace

void loopCosts(sk::Device& device, int rounds, Report& report) {
  loopCostsOf(device, 8, {}, rounds, report);
  loopCostsOf(device, 64, 1.0, rounds, report);
  sk::Device native = sk::Device::native();
  loopCostsOf(native, 8, 0.3, rounds, report);
  loopCostsOf(native, 64, {}, rounds, report);
}

}  // namespace bench
