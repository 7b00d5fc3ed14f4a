// SPDX-License-Identifier: MIT
//
// Measures wall-clock times around finish(), because GL's own timers are wrong by a factor of 100 on
// llvmpipe. Runs alternate, and medians are reported, so that a busy machine affects all of them equally.
#include <chrono>
#include <cstdint>
#include <functional>
#include <vector>

#include "info/costs.sk.hpp"
#include "info/device_info.hpp"
#include "info/numbers.hpp"
#include "quantile.hpp"

namespace sk_tool {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int rounds = 7;
constexpr std::int64_t side = 1024;  ///< of the streams that are copied

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Timed {
  std::function<double()> seconds;  ///< runs it once
  std::vector<double> taken = {};
};

/// Runs each once without timing, then all alternately.
void takeTurns(std::vector<Timed>& things) {
  for (Timed& thing : things) thing.seconds();
  for (int round = 0; round < rounds; ++round) {
    for (Timed& thing : things) thing.taken.push_back(thing.seconds());
  }
}

/// Gigabytes (10^9 bytes) per second of writing, reading and copying elements; a copy counts bytes read and
/// written.
template <class T, class CopyKernel>
Json bandwidth(sk::Device& device, const CopyKernel& copy) {
  auto x = device.stream<T>({side, side});
  auto r = device.stream<T>({side, side});
  std::vector<T> host(static_cast<std::size_t>(x.size()));
  const auto timed = [&device](const auto& work) {
    device.finish();
    const Clock::time_point start = Clock::now();
    work();
    device.finish();
    return secondsSince(start);
  };
  constexpr int copies = 4;
  std::vector<Timed> things{
      {[&] { return timed([&] { x.write(host); }); }}, {[&] { return timed([&] { x.read(host); }); }}, {[&] {
        return timed([&] {
          for (int i = 0; i < copies; ++i) copy(x, r);
        });
      }}};
  takeTurns(things);
  const double bytes = static_cast<double>(host.size() * sizeof(T));
  const auto rate = [&](std::size_t i, double moved) {
    return rounded(moved / median(things[i].taken) * 1e-9);
  };
  return {{"upload", rate(0, bytes)}, {"readback", rate(1, bytes)}, {"copy", rate(2, 2 * copies * bytes)}};
}

/// Microseconds per pass over few elements, when each pass depends on the previous one.
void passes(sk::Device& device, Json& json) {
  constexpr int count = 64;
  auto x = device.stream<float>({16, 16});
  auto y = device.stream<float>({16, 16});
  x.write(std::vector<float>(256, 1.0F));
  std::vector<double> queued;
  const auto chain = [&] {
    device.finish();
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < count; i += 2) {
      probes::step(x, y);
      probes::step(y, x);
    }
    queued.push_back(secondsSince(start));
    device.finish();
    return secondsSince(start);
  };
  const auto readBack = [&] {
    device.finish();
    const Clock::time_point start = Clock::now();
    for (int i = 0; i < count; ++i) {
      probes::step(x, x);
      (void)x.domain({0, 0}, {1, 1}).read();
    }
    return secondsSince(start);
  };
  std::vector<Timed> things{{chain}, {readBack}};
  takeTurns(things);
  const auto each = [](const std::vector<double>& taken) { return rounded(median(taken) / count * 1e6); };
  json["call_us"] = each(queued);
  json["pass_us"] = each(things[0].taken);
  json["pass_and_readback_us"] = each(things[1].taken);
}

/// Milliseconds of a program's first call.
double compile(sk::Device& device) {
  auto x = device.stream<float>({4, 4});
  auto salt = static_cast<std::uint32_t>(Clock::now().time_since_epoch().count());
  std::vector<double> taken;
  for (int i = 0; i < 5; ++i) {
    device.finish();
    const Clock::time_point start = Clock::now();
    probes::cold(salt++, x, x);
    device.finish();
    taken.push_back(secondsSince(start));
  }
  return rounded(median(taken) * 1e3);
}

}  // namespace

Json probeCosts(sk::Device& device) {
  Json json;
  json["gigabytes_per_second"] = {{"float", bandwidth<float>(device, probes::copyScalars)},
                                  {"float4", bandwidth<sk::float4>(device, probes::copyVectors)}};
  passes(device, json);
  if (!isNative(device)) json["compile_ms"] = compile(device);
  return json;
}

}  // namespace sk_tool
