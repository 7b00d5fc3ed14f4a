// SPDX-License-Identifier: MIT
#include "probe/copy_bandwidth.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "gl/commands.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/transfer/copy_kernel.hpp"
#include "sk/error.hpp"
#include "support/cache_folder.hpp"
#include "trace/trace.hpp"

namespace sk {

namespace {

/// The size of each of the two streams, which exceeds caches.
constexpr std::int64_t rows = 4096, columns = 2048;
constexpr std::int64_t streamBytes = rows * columns * static_cast<std::int64_t>(sizeof(float4));
constexpr int rounds = 4;
/// Shorter copies are repeated, so that waiting for the end does not matter.
constexpr Trace::Time leastTime = 10'000'000;
/// The time in which an idle GPU reaches its full clock rate (an H200: 0.2 s).
constexpr Trace::Time wakingTime = 300'000'000;

/// The best of several rounds; copy(times) returns when all copies are done.
template <class Copy>
double measure(Copy&& copy) {
  double best = 0;
  int times = 1;
  for (int round = 0; round < rounds; ++round) {
    const Trace::Time start = Trace::now();
    copy(times);
    const Trace::Time took = std::max<Trace::Time>(Trace::now() - start, 1);
    best = std::max(best, static_cast<double>(2 * streamBytes) * times / static_cast<double>(took));
    if (took < leastTime) times = static_cast<int>(std::min<Trace::Time>(times * leastTime / took + 1, 256));
  }
  return best;
}

double measureDevice(GlDevice& device) {
  const program::Element& element = ElementTraits<float4>::element();
  const Layout layout = layoutOf({rows, columns}, device.textureLimits());
  const assemble::Stage stage =
      device.programs().stageOf(copyKernel(element.fields[0]), KernelClass::Elements, {});
  const DeviceScope scope(device);
  PlanesLease from(device.memory()), to(device.memory());
  try {
    from.add(element, layout.texture, "measuring how fast the device copies");
    to.add(element, layout.texture, "measuring how fast the device copies");
  } catch (const Error&) {
    return 0;
  }
  device.programs().select({}, stage);
  const auto draw = [&](std::span<RenderTarget> source, std::span<RenderTarget> target) {
    const Operand operands[] = {{nullptr, layout.whole, source}, {}};
    RenderTarget* const targets[] = {&target.front()};
    runKernel(device, copyKernel(element.fields[0]), operands, layout.whole, layout.draws, targets);
  };
  draw(from.planes, to.planes);
  draw(to.planes, from.planes);  // both have been written before, so that their memory is allocated
  if (!device.isSoftware()) {
    for (const Trace::Time start = Trace::now(); Trace::now() - start < wakingTime; gl::finish()) {
      draw(from.planes, to.planes);
    }
  }
  const double drawn = measure([&](int times) {
    for (int i = 0; i < times; ++i) draw(from.planes, to.planes);
    gl::finish();
  });
  const double copied = measure([&](int times) {
    for (int i = 0; i < times; ++i)
      copyRegion(device, element, from.planes, layout.whole, to.planes, layout.whole);
    gl::finish();
  });
  return std::max(drawn, copied);
}

double measureHost() {
  const std::size_t threads = std::max(std::thread::hardware_concurrency(), 1U);
  const auto bytes = static_cast<std::size_t>(streamBytes) / threads;
  try {
    const auto from = std::make_unique<std::byte[]>(bytes * threads);
    const auto to = std::make_unique<std::byte[]>(bytes * threads);
    return measure([&](int times) {
      std::vector<std::jthread> all;
      for (std::size_t thread = 0; thread < threads; ++thread) {
        all.emplace_back([&, place = thread * bytes] {
          for (int i = 0; i < times; ++i) std::memcpy(to.get() + place, from.get() + place, bytes);
        });
      }
    });
  } catch (const std::exception&) {
    return 0;  // no memory or no threads
  }
}

}  // namespace

double copyBandwidth(GlDevice& device) {
  if (std::int64_t{device.limits.textureSize} < rows) return 0;  // textures are limited for tests
  const std::string key = driverKey(device.name(), device.driver(), device.profileName());
  // a software renderer has the bandwidth of its processor
  return device.cache.measuredOnce("bandwidth", device.isSoftware() ? key + ", " + processorKey() : key,
                                   [&] { return measureDevice(device); });
}

double hostCopyBandwidth() {
  return CacheFolder().measuredOnce("bandwidth", driverKey("native", processorKey(), ""), measureHost);
}

}  // namespace sk
