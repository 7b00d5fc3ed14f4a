// SPDX-License-Identifier: MIT
//
// readAsync() and writeAsync(): a future holds the elements as they were at the call, whatever happens afterwards.
#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include <epoxy/gl.h>

#include <catch2/catch.hpp>

#include "elements.hpp"
#include "error_of.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

const TestKernel& plusOne() {
  static const TestKernel kernel("plus_one", "void plus_one(float x, out float r) { r = x + 1.0; }\n",
                                 {input<float>("x"), output<float>("r")});
  return kernel;
}

/// Thousands of operations per element, so that the device is still computing when the call returns.
const TestKernel& slow() {
  static const TestKernel kernel(
      "slow",
      "void slow(float x, out float r) { r = x; for (int i = 0; i < 1000; ++i) { r = sin(r) + x; } }\n",
      {input<float>("x"), output<float>("r")});
  return kernel;
}

std::vector<Device> devices() {
  std::vector<Device> all;
  for (const std::string& profile : profileNames) {
    for (const int limit : {0, 64})
      all.emplace_back(DeviceOptions{.profile = profile, .textureLimit = limit});
  }
  all.push_back(Device::native());
  return all;
}

double milliseconds(std::chrono::steady_clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace

TEMPLATE_TEST_CASE("what is written and read without waiting is what was given, bit for bit", "", float,
                   float3, int2, std::uint8_t, short3, unorm8, snorm16x2, half, float2x2) {
  for (Device& device : devices()) {
    for (const Shape& shape :
         {Shape{0}, Shape{1}, Shape{65}, Shape{9, 13}, Shape{5, 0}, Shape{70, 80}, Shape{3, 4, 5}}) {
      INFO(device.name() << ", shape " << toString(shape) << " of "
                         << ElementTraits<TestType>::element().name);
      auto stream = device.stream<TestType>(shape);
      const auto elements = patterned<TestType>(static_cast<std::size_t>(shape.size()));
      stream.writeAsync(elements);
      Future<TestType> future = stream.readAsync();
      CHECK(haveSameBits(stream.read(), elements));
      CHECK(future.valid());
      CHECK(haveSameBits(future.get(), elements));
      CHECK_FALSE(future.valid());
    }
  }
}

TEST_CASE("views, structs and bools are read and written without waiting") {
  for (Device& device : devices()) {
    INFO(device.name());
    auto field = device.stream<float>({70, 80});
    std::vector<float> values(70 * 80, 1);
    field.write(values);
    auto view = field.domain({3, 4}, {60, 50});
    const std::vector<float> part(57 * 46, 2);
    view.writeAsync(part);
    CHECK(view.readAsync().get() == part);
    for (int y = 3; y < 60; ++y) {
      for (int x = 4; x < 50; ++x) values[static_cast<std::size_t>(y * 80 + x)] = 2;
    }
    CHECK(field.readAsync().get() == values);

    auto hits = device.stream<Hit>({30});
    std::vector<Hit> given(30);
    for (int i = 0; i < 30; ++i) given[static_cast<std::size_t>(i)] = {static_cast<float>(i), -i};
    hits.writeAsync(given);
    const std::vector<Hit> found = hits.readAsync().get();
    REQUIRE(found.size() == given.size());
    for (std::size_t i = 0; i < given.size(); ++i) {
      CHECK((found[i].t == given[i].t && found[i].id == given[i].id));
    }

    auto flags = device.stream<bool>({3});
    const std::vector<std::uint8_t> bytes{1, 0, 1};
    flags.writeAsync(bytes);
    CHECK(flags.readAsync().get() == std::vector<std::uint8_t>{1, 0, 1});

    auto halves = device.stream<float>({4, 5}, Storage::Half);
    halves.writeAsync(std::vector<float>(20, 1.0001F));
    CHECK(halves.readAsync().get() == std::vector<float>(20, 1));
  }
}

TEST_CASE("any thread may destroy futures while another one uses the device, and while it ends") {
  constexpr std::size_t threads = 3, each = 500;
  for (const std::string& profile : profileNames) {
    auto device = std::make_unique<Device>(DeviceOptions{.profile = profile});
    auto x = device->stream<float>({16});
    const std::vector<float> values(16, 2.5F);
    x.write(values);
    std::vector<std::vector<Future<float>>> unwanted(threads);
    for (std::size_t i = 0; i < threads * each; ++i) unwanted[i % threads].push_back(x.readAsync());
    std::vector<std::jthread> others;
    for (std::vector<Future<float>>& mine : unwanted) others.emplace_back([&mine] { mine.clear(); });
    int wrong = 0;
    for (int i = 0; i < 300; ++i) wrong += x.readAsync().get() == values ? 0 : 1;
    CHECK(wrong == 0);
    others.clear();
    std::vector<Future<float>> last;
    for (int i = 0; i < 100; ++i) last.push_back(x.readAsync());
    const std::jthread other([&last] { last.clear(); });
    device.reset();
  }
}

TEST_CASE("buffers of futures that have ended do not stay") {
  for (const std::string& profile : profileNames) {
    Device device(DeviceOptions{.profile = profile});
    auto x = device.stream<float>({512, 512});  // 1 MiB
    x.write(std::vector<float>(512 * 512, 1));
    device.makeCurrent();
    const auto buffers = [] {
      int count = 0;
      for (GLuint name = 1; name < 1000; ++name) count += glIsBuffer(name) == GL_TRUE ? 1 : 0;
      return count;
    };
    {
      std::vector<Future<float>> futures;
      for (int i = 0; i < 100; ++i) futures.push_back(x.readAsync());
      CHECK(buffers() >= 100);
    }
    for (int call = 0; call < 20; ++call) device.finish();
    CHECK(buffers() <= 64);
    CHECK(x.readAsync().get() == std::vector<float>(512 * 512, 1));
  }
}

TEST_CASE("later calls do not disturb what was asked for") {
  for (Device& device : devices()) {
    if (device.profile() == "native") continue;  // kernels of tests have no native code
    INFO(device.name());
    auto x = device.stream<float>({64, 64}), r = device.stream<float>({64, 64});
    x.write(std::vector<float>(64 * 64, 0));
    std::vector<Future<float>> futures;
    for (int i = 0; i < 5; ++i) {
      futures.push_back(x.readAsync());
      plusOne()(x, r);
      plusOne()(x, x);
      if (i == 3) x.writeAsync(std::vector<float>(64 * 64, 100));
    }
    for (const int i : {4, 0, 2, 1, 3}) {
      const std::vector<float> found = futures[static_cast<std::size_t>(i)].get();
      CHECK(found == std::vector<float>(64 * 64, i == 4 ? 100 : static_cast<float>(i)));
    }
  }
}

TEST_CASE("neither asking nor writing waits for the device") {
  Device device;
  const std::int64_t side = device.isSoftware() ? 10 : 512;  // times are not compared on a software renderer
  const auto count = static_cast<std::size_t>(side * side);
  auto x = device.stream<float>({side, side}), r = device.stream<float>({side, side});
  x.write(std::vector<float>(count, 0.5F));
  r.writeAsync(std::vector<float>(count, 0.5F));
  r.domain({1, 1}, {9, 9}).writeAsync(std::vector<float>(64, 0));
  slow()(x, r);
  r.readAsync().get();
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto before = now();
  slow()(x, r);
  device.finish();
  const auto start = now();
  slow()(x, r);
  Future<float> future = r.readAsync();
  const auto asked = now();
  r.writeAsync(std::vector<float>(count, 0.25F));
  r.domain({1, 1}, {9, 9}).writeAsync(std::vector<float>(64, 0));
  const auto written = now();
  const bool wasReady = future.ready();
  future.wait();
  CHECK(future.ready());
  const double whole = milliseconds(start - before);
  INFO("the kernel " << whole << " ms, asking " << milliseconds(asked - start) << " ms, writing "
                     << milliseconds(written - asked) << " ms");
  if (whole > 50 &&
      !device.isSoftware()) {  // else the device is too fast, or finishes drawing before a read returns
    CHECK_FALSE(wasReady);
    CHECK(milliseconds(written - start) < whole / 2);
  }
  CHECK(future.get().front() != 0.25F);
  CHECK(r.read().back() == 0.25F);
}

TEST_CASE("a future outlives its stream and its device") {
  for (Device& device : devices()) {
    INFO(device.name());
    const std::vector<float> elements = patterned<float>(1000);
    Future<float> future, other, dropped;
    {
      auto stream = device.stream<float>({1000});
      stream.write(elements);
      future = stream.readAsync();
      other = stream.readAsync();
      dropped = stream.domain({10}, {20}).readAsync();
    }
    CHECK(haveSameBits(other.get(), elements));
    const std::optional<Device> ended(std::move(device));
  }
  for (Device& device : devices()) {
    std::optional<Device> ending(std::move(device));
    auto stream = ending->stream<float>({1000}), half = ending->stream<float>({1000}, Storage::Half);
    stream.write(std::vector<float>(1000, 1.0001F));
    half.write(std::vector<float>(1000, 1.0001F));
    Future<float> future = stream.readAsync(), ofHalf = half.readAsync();
    ending.reset();
    CHECK(future.ready());
    future.wait();
    CHECK(future.get() == std::vector<float>(1000, 1.0001F));
    CHECK(ofHalf.get() == std::vector<float>(1000, 1));
  }
}

TEST_CASE("futures without elements, and transfers of another size, are errors") {
  const std::string nothing =
      "the future has no elements: it was made of nothing, moved from, or asked for them before";
  Future<float> none;
  CHECK_FALSE(none.valid());
  CHECK(errorOf([&] { none.get(); }) == nothing);
  CHECK(errorOf([&] { none.wait(); }) == nothing);
  CHECK(errorOf([&] { (void)none.ready(); }) == nothing);
  Device device;
  auto stream = device.stream<float>({4});
  CHECK(errorOf([&] { stream.writeAsync(std::vector<float>(3)); }) ==
        "writeAsync: 3 element(s) in host memory, but shape {4} has 4; give exactly as many");
  Future<float> future = stream.readAsync();
  future.get();
  CHECK(errorOf([&] { future.get(); }) == nothing);
}
