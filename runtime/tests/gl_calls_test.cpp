// SPDX-License-Identifier: MIT
//
// Which GL functions a kernel's call calls: none that would set state that is already set. Counting calls instead of
// measuring time makes the test fail on every machine as soon as a call costs more.
#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"
#include "skip.hpp"
#include "test_kernel.hpp"

namespace {

using namespace sk;
using namespace sk::test;
using Names = std::vector<std::string>;

/// The names of the called functions, in order.
Names called;

/// Records the calls of a function while it lives. `place` is libepoxy's pointer to the driver's function.
template <auto* place, class F = std::remove_pointer_t<decltype(place)>>
class Spy;
template <auto* place, class R, class... A>
class Spy<place, R (*)(A...)> {
 public:
  explicit Spy(std::string_view name) {
    name_ = name;
    driver_ = *place;
    *place = note;
  }
  ~Spy() { *place = driver_; }
  Spy(const Spy&) = delete;
  Spy& operator=(const Spy&) = delete;

 private:
  static R note(A... arguments) {
    called.emplace_back(name_);
    return driver_(arguments...);
  }
  static inline std::string_view name_;
  static inline R (*driver_)(A...) = nullptr;
};

#define SPY(function) \
  const Spy<&epoxy_##function> function##Spy { #function }

/// The functions that `work` calls. It must have run before, so that libepoxy has resolved the driver's functions.
template <class Work>
Names callsOf(Work&& work) {
  SPY(glUseProgram);
  SPY(glBindVertexArray);
  SPY(glBindFramebuffer);
  SPY(glFramebufferTexture2D);
  SPY(glCheckFramebufferStatus);
  SPY(glDrawBuffers);
  SPY(glViewport);
  SPY(glViewportIndexedf);
  SPY(glScissor);
  SPY(glEnable);
  SPY(glDisable);
  SPY(glActiveTexture);
  SPY(glBindTexture);
  SPY(glBindSampler);
  SPY(glTexParameteri);
  SPY(glBindImageTexture);
  SPY(glUniform1i);
  SPY(glUniform1iv);
  SPY(glUniform4iv);
  SPY(glUniform1f);
  SPY(glUniform1fv);
  SPY(glUniform4fv);
  SPY(glGetUniformLocation);
  SPY(glGetIntegerv);
  SPY(glGetError);
  SPY(glFlush);
  SPY(glFinish);
  SPY(glFenceSync);
  SPY(glDrawArrays);
  SPY(glDrawArraysIndirect);
  SPY(glDispatchCompute);
  SPY(glDispatchComputeIndirect);
  SPY(glMemoryBarrier);
  SPY(glReadPixels);
  SPY(glBindBufferBase);
  SPY(glBufferData);
  SPY(glGetBufferSubData);
  SPY(glMapBufferRange);
  called.clear();
  work();
  return called;
}

struct Streams {
  explicit Streams(Device& device)
      : x(device.stream<float>({8, 8})),
        y(device.stream<float>({8, 8})),
        r(device.stream<float>({8, 8})),
        s(device.stream<float>({8, 8})) {
    const std::vector<float> ones(64, 1.0f);
    for (Stream<float>* stream : {&x, &y, &r, &s}) stream->write(ones);
    // Makes every program and framebuffer that the tests need.
    saxpy()(1.0f, x, y, s);
    saxpy()(1.0f, y, x, r);
    saxpy()(2.0f, x, y, r);
  }
  Stream<float> x, y, r, s;
};

}  // namespace

TEST_CASE("a call draws, and sets what has changed") {
  for (const std::string& profile : profileNames) {
    CAPTURE(profile);
    Device device(DeviceOptions{.profile = profile});
    Streams of(device);
    CHECK(callsOf([&] { saxpy()(2.0f, of.x, of.y, of.r); }) == Names{"glDrawArrays"});
    CHECK(callsOf([&] { saxpy()(3.0f, of.x, of.y, of.r); }) == Names{"glUniform1fv", "glDrawArrays"});
    CHECK(callsOf([&] { saxpy()(3.0f, of.x, of.x, of.r); }) == Names{"glBindTexture", "glDrawArrays"});
    CHECK(callsOf([&] { saxpy()(3.0f, of.x, of.x, of.s); }) == Names{"glBindFramebuffer", "glDrawArrays"});
    CHECK(callsOf([&] { saxpy()(3.0f, of.r, of.x, of.s); }) ==
          Names{"glActiveTexture", "glBindTexture", "glDrawArrays"});
  }
}

TEST_CASE("a call dispatches, and sets what has changed") {
  Device device(DeviceOptions{.profile = GENERATE("glsl430", "essl310")});
  Streams of(device);
  CHECK(callsOf([&] { saxpy()(2.0f, of.x, of.y, of.r); }) == Names{"glDispatchCompute", "glMemoryBarrier"});
  CHECK(callsOf([&] { saxpy()(3.0f, of.x, of.y, of.r); }) ==
        Names{"glUniform1fv", "glDispatchCompute", "glMemoryBarrier"});
  CHECK(callsOf([&] { saxpy()(3.0f, of.x, of.y, of.s); }) ==
        Names{"glBindImageTexture", "glDispatchCompute", "glMemoryBarrier"});
}

TEST_CASE("a loop gives the commands again that change something") {
  for (const std::string profile : {"glsl330", "essl300", "glsl430", "essl310"}) {
    CAPTURE(profile);
    Device device(DeviceOptions{.profile = profile});
    Streams of(device);
    Loop loop = device.record([&] {
      saxpy()(2.0f, of.x, of.y, of.r);
      std::swap(of.y, of.r);
    });
    loop.repeat(7);
    const bool isDispatched = profile == "glsl430" || profile == "essl310";
    const Names one =
        isDispatched ? Names{"glBindTexture", "glBindImageTexture", "glDispatchCompute", "glMemoryBarrier"}
                     : Names{"glBindTexture", "glBindFramebuffer", "glDrawArrays"};
    Names expected;
    for (int i = 0; i < 5; ++i) expected.insert(expected.end(), one.begin(), one.end());
    Names given = callsOf([&] { loop.repeat(5); });
    for (Names* const names : {&expected, &given}) std::ranges::sort(*names);  // bindings come in any order
    CHECK(given == expected);
    Loop same = device.record([&] { saxpy()(2.0f, of.x, of.s, of.r); });
    same.repeat(3);
    CHECK(callsOf([&] { same.repeat(2); }) == (isDispatched ? Names{"glDispatchCompute", "glMemoryBarrier",
                                                                    "glDispatchCompute", "glMemoryBarrier"}
                                                            : Names{"glDrawArrays", "glDrawArrays"}));
  }
}

TEST_CASE("a loop that the device ends is queued with counts from a buffer") {
  static const TestKernel isLarge("isLarge", "void isLarge(float x, out bool r) { r = x > 900.0; }\n",
                                  {input<float>("x"), output<bool>("r")});
  Device device(DeviceOptions{.profile = GENERATE("glsl430", "essl310")});
  Streams of(device);
  auto done = device.stream<bool>({8, 8});
  const float two = 2;
  const Argument drawn[] = {argumentOf(two), argumentOf(of.x), argumentOf(of.y), argumentOf(of.s)};
  Loop loop = device.record([&] {
    saxpy()(1.0f, of.x, of.y, of.r);
    run(saxpy().kernel(), drawn, {.target = Target::Fragment});
    isLarge(of.r, done);
  });
  const auto condition = done.domain({7, 3}, {8, 4});
  CHECK(loop.until(condition, {.every = 2, .most = 9}) == 9);
  const Names calls = callsOf([&] { CHECK(loop.until(condition, {.every = 8, .most = 24}) == 24); });
  CHECK(std::ranges::count(calls, "glDrawArraysIndirect") == 24);
  CHECK(std::ranges::count(calls, "glDispatchComputeIndirect") == 48);
  CHECK(std::ranges::count(calls, "glDispatchCompute") == 24);  // of the gate
  CHECK(std::ranges::count(calls, "glDrawArrays") == 0);
  CHECK(std::ranges::count(calls, "glReadPixels") == 0);
  CHECK(std::ranges::count(calls, "glGetBufferSubData") + std::ranges::count(calls, "glMapBufferRange") <= 4);
}

// On a GPU, reading a texel back takes longer than computing a small sum.
TEST_CASE("the value of a dispatched reduction comes through a buffer") {
  const std::string profile = GENERATE("glsl430", "essl310");
  Device device(DeviceOptions{.profile = profile});
  const TestReduction sum("sum", "void sum(float x, inout float total) { total += x; }\n",
                          {input<float>("x"), accumulator<float>("total", "0.0")}, true);
  auto x = device.stream<float>({8, 8});
  x.write(std::vector<float>(64, 1.0f));
  CHECK(sum.value<float>(x) == 64);
  CHECK(callsOf([&] { CHECK(sum.value<float>(x) == 64); }) ==
        Names{"glUseProgram", "glBindTexture", "glDispatchCompute", "glMemoryBarrier",  // folds the elements
              "glUseProgram", "glBindTexture", "glDispatchCompute",
              "glMemoryBarrier",  // folds the work groups' partial results
              "glMemoryBarrier", profile == "essl310" ? "glMapBufferRange" : "glGetBufferSubData",
              "glGetError"});
}

TEST_CASE("what compute programs of OpenGL ES cannot write is drawn") {
  static const TestKernel two("two", "void two(float x, out vec2 r) { r = vec2(x, 2.0 * x); }\n",
                              {input<float>("x"), output<float2>("r")});
  static const TestKernel four("four", "void four(float x, out vec4 r) { r = vec4(x); }\n",
                               {input<float>("x"), output<float4>("r")});
  Device device({.profile = "essl310", .limits = "guaranteed"});
  CHECK(device.profile() == "essl310");
  CHECK(device.limits().images == 4);
  auto x = device.stream<float>({8, 8});
  x.write(std::vector<float>(64, 3.0f));
  auto pairs = device.stream<float2>({8, 8});
  auto fours = device.stream<float4>({8, 8});
  two(x, pairs);
  four(x, fours);
  const auto has = [](const Names& calls, std::string_view name) {
    return std::ranges::count(calls, name) > 0;
  };
  const Names ofPairs = callsOf([&] { two(x, pairs); }), ofFours = callsOf([&] { four(x, fours); });
  CHECK(has(ofPairs, "glDrawArrays"));
  CHECK_FALSE(has(ofPairs, "glDispatchCompute"));
  CHECK_FALSE(has(ofFours, "glDrawArrays"));
  CHECK(has(ofFours, "glDispatchCompute"));
  CHECK(pairs.read()[63].y == 6);
  CHECK(fours.read()[63].w == 3);
  const Argument arguments[] = {argumentOf(x), argumentOf(pairs)};
  CHECK(errorOf([&] {
          run(two.kernel(), arguments, {.target = Target::Compute});
        }).find("that fit the device's 4 images and their formats") != std::string::npos);
}

// A software renderer copies all of its state when a uniform of the fragment program changes.
TEST_CASE("a renderer in software takes arguments as uniforms of the vertex program") {
  Device device(DeviceOptions{.profile = "glsl330"});
  Streams of(device);
  const std::string_view renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (!renderer.starts_with("llvmpipe") || epoxy_gl_version() < 43) {
    skip("only llvmpipe with OpenGL 4.3 tells which stage reads a uniform");
    return;
  }
  GLint program = 0;
  glGetIntegerv(GL_CURRENT_PROGRAM, &program);
  const GLuint argument = glGetProgramResourceIndex(static_cast<GLuint>(program), GL_UNIFORM, "sk_arg_a");
  REQUIRE(argument != GL_INVALID_INDEX);
  const GLenum asked = GL_REFERENCED_BY_FRAGMENT_SHADER;
  GLint isFragments = -1;
  glGetProgramResourceiv(static_cast<GLuint>(program), GL_UNIFORM, argument, 1, &asked, 1, nullptr,
                         &isFragments);
  CHECK(isFragments == GL_FALSE);
}

TEST_CASE("streams take the textures of streams of their shape that are gone") {
  Device device(DeviceOptions{.profile = "glsl330"});
  const auto useTwo = [&](int width) {
    auto a = device.stream<float4>({512, 512 + width % 3}), b = device.stream<float4>({512, 512 + width % 3});
    const std::vector<float4> values(static_cast<std::size_t>(a.size()), float4{1, 2, 3, float(width)});
    a.write(values);
    b.fill(float4{0, 0, 0, 4});
    CHECK(a.read() == values);
  };
  const auto texturesMadeFor = [&](int first, int last) {
    SPY(glGenTextures);
    called.clear();
    for (int i = first; i < last; ++i) useTwo(i);
    return called.size();
  };
  useTwo(0);
  CHECK(texturesMadeFor(1, 3) == 4);
  CHECK(texturesMadeFor(3, 30) == 0);
}
