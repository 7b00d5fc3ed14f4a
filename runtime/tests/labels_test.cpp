// SPDX-License-Identifier: MIT
//
// The KHR_debug labels of textures and programs, which debuggers show. Objects are labelled while there is a trace.
#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <epoxy/gl.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "skip.hpp"
#include "test_kernel.hpp"

namespace {

using namespace sk;
using namespace sk::test;

/// Sets SK_TRACE while it lives, and removes the trace's file at the end.
class Traced {
 public:
  explicit Traced(std::string file) : file_(std::move(file)) { ::setenv("SK_TRACE", file_.c_str(), 1); }
  ~Traced() {
    ::unsetenv("SK_TRACE");
    std::filesystem::remove(file_);
  }
  Traced(const Traced&) = delete;
  Traced& operator=(const Traced&) = delete;

 private:
  std::string file_;
};

std::string labelOf(GLenum kind, GLuint name) {
  std::array<char, 256> label{};
  glGetObjectLabel(kind, name, static_cast<GLsizei>(label.size()), nullptr, label.data());
  return label.data();
}

bool hasProgram(const std::string& label) {
  for (GLuint name = 1; name < 256; ++name) {
    if (glIsProgram(name) == GL_TRUE && labelOf(GL_PROGRAM, name) == label) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("textures and programs have the names of streams and kernels while there is a trace") {
  static const TestKernel twice("heat::twice", "void heat_twice(vec4 x, out vec4 r) { r = 2.0 * x; }\n",
                                {input<float4>("x"), output<float4>("r")});
  const Traced traced(std::filesystem::temp_directory_path() / ("sk_labels_" + std::to_string(::getpid())));
  for (const std::string& profile : profileNames) {
    Device device(DeviceOptions{.profile = profile});
    auto u = device.stream<float4>({4, 4}, Storage::Default, "heat::u");
    if (!epoxy_has_gl_extension("GL_KHR_debug")) {
      skip("the driver has no labels (GL_KHR_debug) in " + profile);
      continue;
    }
    CHECK(labelOf(GL_TEXTURE, u.texture().name) == "heat::u");
    const GLuint before = u.texture().name;
    twice(u, u);
    CHECK(u.texture().name != before);
    CHECK(labelOf(GL_TEXTURE, u.texture().name) == "heat::u");
    CHECK(hasProgram("heat::twice"));
    const auto unnamed = device.stream<float>({4, 8});
    CHECK(labelOf(GL_TEXTURE, unnamed.texture().name) == "a stream of float of shape {4, 8}");
  }
}

TEST_CASE("a trace takes the host's time where the driver has no clock") {
  const Traced traced(std::filesystem::temp_directory_path() / ("sk_clock_" + std::to_string(::getpid())));
  Device device(DeviceOptions{.profile = "essl300"});
  auto x = device.stream<float>({4, 4});
  x.write(std::vector<float>(16, 2.5F));
  twice()(x, x);
  CHECK(x.read() == std::vector<float>(16, 5));
  CHECK_NOTHROW(device.finish());
}

TEST_CASE("no device is made where its trace cannot be written") {
  const Traced traced("/no/such/folder/trace.json");
  CHECK_THROWS_WITH(Device(), Catch::Contains("SK_TRACE: '/no/such/folder/trace.json' cannot be written"));
  CHECK_THROWS_WITH(Device::native(), Catch::Contains("SK_TRACE"));
}
