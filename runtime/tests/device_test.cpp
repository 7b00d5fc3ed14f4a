// SPDX-License-Identifier: MIT
//
// Devices: their names and limits, several at once, threads, and the context that they leave current.
#include <cstdlib>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include <epoxy/egl.h>
#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "sk/sk.hpp"
#include "skip.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

/// Runs a kernel and checks its result.
void use(Device& device) {
  auto x = device.stream<float>(3);
  auto r = device.stream<float>(3);
  x.write(std::vector<float>{1, 2, 3});
  twice()(x, r);
  CHECK(r.read() == std::vector<float>{2, 4, 6});
}

}  // namespace

TEST_CASE("a device tells what it is") {
  Device device({.profile = "glsl330"});
  CHECK_FALSE(device.name().empty());
  CHECK(device.profile() == "glsl330");
  CHECK(device.limits().textureSize >= (std::getenv("SK_TEXTURE_LIMIT") == nullptr ? 1024 : 4));
  CHECK(device.limits().textureLayers >= 256);
  CHECK(device.limits().drawBuffers >= 8);
  CHECK(device.limits().textureUnits >= 16);
  Device es({.profile = "essl300", .textureLimit = 100});
  CHECK(es.profile() == "essl300");
  CHECK(es.limits().textureSize == 100);
  CHECK(es.limits().drawBuffers >= 4);
  CHECK(es.limits().images == 0);
  Device dispatching({.profile = "essl310", .limits = "guaranteed"});
  CHECK(dispatching.profile() == "essl310");
  CHECK(dispatching.limits().drawBuffers == 4);
  CHECK(dispatching.limits().images == 4);
  CHECK(dispatching.limits().uniformComponents == 512);
}

TEST_CASE("a device tells how much memory it has, if anybody does, and no more than the limit") {
  for (const bool isNative : {false, true}) {
    CAPTURE(isNative);
    const std::string name = isNative ? "native" : "";
    Device device({.device = name, .profile = isNative ? "" : "glsl330"});
    const auto memory = device.limits().memory, available = device.availableMemory();
    if (device.isSoftware()) {  // the host's
      REQUIRE(memory.has_value());
      REQUIRE(available.has_value());
      CHECK(*available > 0);
    }
    if (memory && available) CHECK(*available <= *memory);
    Device small({.device = name, .profile = isNative ? "" : "essl300", .memoryLimit = 1000});
    CHECK(small.limits().memory == 1000);
    CHECK(small.availableMemory() == 1000);
    auto x = small.stream<float>({1000});  // no limit of streams
    x.fill(2.0f);
    CHECK(x.read()[999] == 2.0f);
  }
  CHECK(errorOf([] { Device(DeviceOptions{.memoryLimit = -1}); }) ==
        "the memory limit '-1' is no number of bytes from 1 on (option or SK_MEMORY_LIMIT)");
}

TEST_CASE("what doubles may be") {
  CHECK(errorOf([] { Device(DeviceOptions{.doubles = "long"}); }) ==
        "there are no doubles 'long'; choose native or pairs (option or SK_DOUBLES)");
}

TEST_CASE("a device is chosen by a part of its name, in any case") {
  Device device;
  std::string name = device.name();
  CHECK(Device(name.substr(1, 4)).name() == name);
  for (char& c : name) {
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  CHECK(Device(name).name() == device.name());
  CHECK(errorOf([] {
          Device("no such renderer");
        }).find("no device 'no such renderer' was found; tried without a window:\n") == 0);
  CHECK(errorOf([] { Device("gpu:one"); }) ==
        "'gpu:one' names no device; after 'gpu:' comes a number, from 0");
  CHECK(errorOf([] { Device({.profile = "glsl110"}); }) ==
        "there is no profile 'glsl110'; choose one of glsl330, essl300, glsl430, essl310 "
        "(option or SK_PROFILE)");
}

TEST_CASE("a kernel without native code names the way out on a native device") {
  Device native("native");
  auto x = native.stream<float>(2);
  CHECK(
      errorOf([&] { twice()(x, x); }) ==
      "twice: it has no native code; compile its .sk file with skc --target=fragment,native, or run it on a "
      "device with GL (SK_DEVICE=gl)");
}

TEST_CASE("devices of both profiles in one process, used in turn") {
  Device gl({.profile = "glsl330"});
  Device es({.profile = "essl300"});
  for (int i = 0; i < 3; ++i) {
    use(gl);
    use(es);
  }
  auto a = gl.stream<float>(2);
  auto b = es.stream<float>(2);
  a.write(std::vector<float>{1, 2});
  b.write(a.read());
  twice()(b, b);
  CHECK(b.read() == std::vector<float>{2, 4});
}

TEST_CASE("many devices come and go, in any order, before and after their streams") {
  std::vector<std::unique_ptr<Device>> devices;
  std::vector<Stream<float>> streams;
  for (int i = 0; i < 8; ++i) {
    devices.push_back(std::make_unique<Device>());
    streams.push_back(devices.back()->stream<float>(100));
    use(*devices.back());
  }
  devices.erase(devices.begin() + 3);
  streams.erase(streams.begin() + 5);
  devices.erase(devices.begin());
  use(*devices.back());
  *devices.back() = Device();
  use(*devices.back());
  devices.clear();
}

TEST_CASE("a device on each of several threads") {
  std::vector<std::thread> threads;
  std::vector<int> rights(4);
  for (int& right : rights) {
    threads.emplace_back([&right] {
      Device device;
      for (int round = 0; round < 20; ++round) {
        auto x = device.stream<float>(1000);
        x.write(std::vector<float>(1000, static_cast<float>(round)));
        twice()(x, x);
        right += x.read() == std::vector<float>(1000, 2.0f * static_cast<float>(round));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  CHECK(rights == std::vector<int>(4, 20));
}

TEST_CASE("a device goes from one thread to another when it is released") {
  Device device;
  use(device);
  std::string error;
  std::thread([&] { error = errorOf([&] { device.stream<float>(1); }); }).join();
  CHECK(error.find("the device is in use by another thread") == 0);
  device.release();
  std::vector<float> result;
  std::thread([&] {
    auto x = device.stream<float>(1);
    x.write(std::vector<float>{21});
    twice()(x, x);
    result = x.read();
    device.release();
  }).join();
  CHECK(result == std::vector<float>{42});
  use(device);
}

TEST_CASE("a device that another thread holds may be destroyed") {
  std::optional<Device> device(std::in_place);
  auto stream = device->stream<float>(10);
  use(*device);
  std::thread([&] { device.reset(); }).join();
  CHECK(errorOf([&] { (void)stream.read(); }).find("has been destroyed") != std::string::npos);
}

TEST_CASE("a call puts back the context that was current, and the last device leaves none") {
  Device first;
  use(first);
  EGLContext held = eglGetCurrentContext();
  CHECK(held != EGL_NO_CONTEXT);
  {
    Device second;
    use(second);
    CHECK(eglGetCurrentContext() == held);
    auto stream = second.stream<float>(4);
    first.release();
    CHECK(eglGetCurrentContext() == EGL_NO_CONTEXT);
  }
  use(first);
  first = Device();
  use(first);
  first.release();
  CHECK(eglGetCurrentContext() == EGL_NO_CONTEXT);
}

TEST_CASE("a stream for which there is no memory") {
  Device device({.textureLimit = 1 << 20});
  if (!device.isSoftware()) {
    skip("a stream beyond the memory would take all of a GPU's, and perhaps block the GPU");
    return;
  }
  const std::int64_t side = device.limits().textureSize;
  const std::string error = errorOf([&] { device.stream<float4>({side, side}); });
  CHECK(error.find("a new stream: '" + device.name() + "' has no memory for a stream of float4 of shape {") ==
        0);
  CHECK(error.find("MiB") != std::string::npos);
  use(device);
}
