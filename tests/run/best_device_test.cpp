// SPDX-License-Identifier: MIT
//
// Promises: the best device is a GPU, else native code. It can run every .sk file of the program, and has GL if an option
// needs GL. If a device lacks what a call needs, the error says what to do.
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "best_device.sk.hpp"
#include "sk/linked_file.hpp"
#include "sk/sk.hpp"
#include "skip.hpp"

namespace {

using sk::program::LinkedFile;

/// Sets or unsets an environment variable while it lives.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    set(value);
  }
  ~Environment() { set(old_ ? old_->c_str() : nullptr); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  void set(const char* value) { value == nullptr ? ::unsetenv(name_) : ::setenv(name_, value, 1); }
  const char* name_;
  std::optional<std::string> old_;
};

/// Unsets all variables that choose a device.
struct NoWishes {
  Environment device{"SK_DEVICE", nullptr}, profile{"SK_PROFILE", nullptr},
      limit{"SK_TEXTURE_LIMIT", nullptr};
};

std::string nameOfBestWith(const sk::DeviceOptions& options = {}) { return sk::Device(options).name(); }

// Initialised before main(); the program's kernels are registered by then.
const sk::Device early = [] {
  const NoWishes none;
  return sk::Device();
}();

TEST_CASE("the best device is a GPU, else native code") {
  const NoWishes none;
  sk::Device gl("gl"), best;
  CHECK(best.name() == (gl.isSoftware() ? "native" : gl.name()));
  CHECK(early.name() == best.name());
  auto x = best.stream<float>({3}), r = best.stream<float>({3});
  x.write(std::vector<float>{1, 2, 3});
  best_device::twice(x, r);
  CHECK(r.read() == std::vector<float>{2, 4, 6});
}

TEST_CASE("the best device has code of every file") {
  const NoWishes none;
  const std::string gl = sk::Device("gl").name();
  {
    const LinkedFile glslAlone({.glsl = true, .native = false});
    CHECK(nameOfBestWith() == gl);
  }
  const LinkedFile nativeAlone({.glsl = false, .native = true});
  CHECK(nameOfBestWith() == "native");
}

TEST_CASE("what only devices with GL have is asked of one") {
  const NoWishes none;
  const std::string gl = sk::Device("gl").name();
  CHECK(sk::Device({.profile = "glsl330"}).profile() == "glsl330");
  CHECK(nameOfBestWith({.textureLimit = 64}) == gl);
  CHECK(nameOfBestWith({.limits = "guaranteed"}) == gl);
  CHECK(nameOfBestWith({.doubles = "pairs"}) == gl);
  CHECK(nameOfBestWith({.barrier = "none"}) == gl);
  CHECK(nameOfBestWith({.sharesContext = true}) == gl);
  const Environment profile("SK_PROFILE", "essl300");
  CHECK(sk::Device().profile() == "essl300");
}

TEST_CASE("a machine without GL has native code") {
  const NoWishes none;
  if (!sk::Device("gl").isSoftware()) {
    skip("a GPU's driver may be found in other ways");
    return;
  }
  const Environment noDrivers("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent");
  CHECK(nameOfBestWith() == "native");
}

TEST_CASE("native devices name the way to what they lack") {
  sk::Device native("native");
  auto x = native.stream<float>({1}), r = native.stream<float>({1});
  const auto wantsGl = Catch::Contains("(SK_DEVICE=gl)");
  CHECK_THROWS_WITH(x.texture(), wantsGl);
  CHECK_THROWS_WITH(x.fillBuffer(1), wantsGl);
  CHECK_THROWS_WITH(native.makeCurrent(), wantsGl);
  CHECK_THROWS_WITH(best_device::twice.with({.target = sk::Target::Fragment})(x, r), wantsGl);
}

}  // namespace
