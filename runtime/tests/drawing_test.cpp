// SPDX-License-Identifier: MIT
//
// What applications use to draw what they compute: the context that they share with a device, and buffers filled from
// streams. Also the count of a device's passes.
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

/// A buffer of the application, filled with 0xff.
GLuint bufferOf(std::size_t bytes) {
  GLuint name = 0;
  glGenBuffers(1, &name);
  glBindBuffer(GL_ARRAY_BUFFER, name);
  const std::vector<unsigned char> ones(bytes, 0xff);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), ones.data(), GL_STATIC_DRAW);
  return name;
}

template <class T>
std::vector<T> contents(GLuint buffer, std::size_t count) {
  std::vector<T> held(count);
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  const void* bytes =
      glMapBufferRange(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(T)), GL_MAP_READ_BIT);
  REQUIRE(bytes != nullptr);
  std::memcpy(held.data(), bytes, count * sizeof(T));
  glUnmapBuffer(GL_ARRAY_BUFFER);
  return held;
}

std::vector<float> ramp(std::size_t count) {
  std::vector<float> values(count);
  std::iota(values.begin(), values.end(), 1.0f);
  return values;
}

}  // namespace

TEST_CASE("an application draws in the context of a device that shares it") {
  const std::string profile = GENERATE(as<std::string>(), "glsl330", "essl300");
  Device device({.profile = profile, .sharesContext = true});
  device.makeCurrent();
  REQUIRE(eglGetCurrentContext() != EGL_NO_CONTEXT);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 1, 1);
  glViewport(3, 4, 5, 6);
  auto x = device.stream<float>({4, 8});
  x.write(ramp(32));
  twice()(x, x);
  CHECK(x.read()[31] == 64);
  GLint viewport[4] = {};
  glGetIntegerv(GL_VIEWPORT, viewport);
  CHECK(std::vector<GLint>(viewport, viewport + 4) == std::vector<GLint>{3, 4, 5, 6});
  GLint bound = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &bound);
  CHECK(static_cast<GLuint>(bound) == framebuffer);
  CHECK(glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE);
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("a device is made current where another context was") {
  Device first, second;
  first.makeCurrent();
  const EGLContext one = eglGetCurrentContext();
  second.makeCurrent();
  CHECK(eglGetCurrentContext() != one);
  const EGLContext other = eglGetCurrentContext();
  auto x = first.stream<float>(1);
  CHECK(eglGetCurrentContext() == other);
}

TEST_CASE("a buffer is filled with the elements of a stream as they lie in its texture") {
  Device device({.sharesContext = true});
  device.makeCurrent();
  SECTION("scalars, packed or not, of any rank, behind an offset") {
    const Shape shape = GENERATE(Shape{4, 8}, Shape{3, 7}, Shape{1000}, Shape{3, 5, 7});
    const auto count = static_cast<std::size_t>(shape.size());
    auto x = device.stream<float>(shape);
    auto r = device.stream<float>(shape);
    x.write(ramp(count));
    twice()(x, r);
    const GLuint buffer = bufferOf((count + 3) * sizeof(float));
    r.fillBuffer(buffer, 2 * sizeof(float));
    const auto held = contents<float>(buffer, count + 3);
    CHECK(std::vector<float>(held.begin() + 2, held.end() - 1) == r.read());
    const auto bits = contents<std::uint32_t>(buffer, count + 3);
    CHECK(bits[1] == 0xffffffff);
    CHECK(bits[count + 2] == 0xffffffff);
  }
  SECTION("vectors; three components take the room of four") {
    auto v = device.stream<float3>({2, 3});
    v.write(std::vector<float3>(6, float3{1, 2, 3}));
    const GLuint buffer = bufferOf(6 * 16);
    v.fillBuffer(buffer);
    CHECK(contents<float>(buffer, 24)[20] == 1);
    CHECK(contents<float>(buffer, 24)[22] == 3);
  }
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("what a buffer cannot be filled with is told") {
  Device device({.sharesContext = true});
  device.makeCurrent();
  auto x = device.stream<float>({4, 8});
  x.write(ramp(32));
  const GLuint buffer = bufferOf(127);
  CHECK(errorOf([&] { x.fillBuffer(buffer); }).find("has 127 bytes, but 128 are needed") !=
        std::string::npos);
  CHECK(errorOf([&] { x.fillBuffer(0); }).find("has 0 bytes") != std::string::npos);
  CHECK(errorOf([&] { x.fillBuffer(buffer, 3); }) ==
        "fillBuffer: the offset is 3; give a multiple of 4, and not a negative one");
  CHECK(errorOf([&] { x.fillBuffer(buffer, 0, 1); }) ==
        "fillBuffer: there is no plane 1; float has 1, from 0");
  Device native = Device::native();
  auto y = native.stream<float>({4, 8});
  CHECK(errorOf([&] { y.fillBuffer(buffer); }).find("has no GL") != std::string::npos);
  CHECK(errorOf([&] { native.makeCurrent(); }).find("has no GL context") != std::string::npos);
}

TEST_CASE("passes and their bytes are counted where somebody asks") {
  Device device;
  auto x = device.stream<float>({64, 64});
  auto r = device.stream<float>({64, 64});
  x.write(ramp(64 * 64));
  CHECK(errorOf([&] { (void)device.passCount(); }).find("countPasses(true)") != std::string::npos);
  device.countPasses(true);
  twice()(x, r);
  twice()(r, r);
  const PassCount two = device.passCount();
  CHECK(two.passes == 2);
  CHECK(two.bytesRead == 2 * 64 * 64 * 4);
  CHECK(two.bytesWritten == 2 * 64 * 64 * 4);
  (void)sumOfFloats().value<float>(r);
  CHECK(device.passCount().passes > 2);
  device.countPasses(true);
  CHECK(device.passCount().passes == 0);
  device.countPasses(false);
  CHECK_THROWS_AS(device.passCount(), Error);
}
