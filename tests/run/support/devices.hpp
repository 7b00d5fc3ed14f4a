// SPDX-License-Identifier: MIT
//
// The devices that a test program runs on, each opened once: native code, and profiles with their own texture limits and with
// small ones, under which most shapes are linearised or need several layers.
//
// Most of a test's time goes into the driver's compiler, so a test runs on no more devices than its promise needs:
//   - onGlAndNative: what a kernel's body computes. The emitter writes one body for all profiles, and tests/golden has glslang
//     compile it in each of them.
//   - onEveryTarget: what the runtime or the assembler does for fragment programs and for compute programs.
//   - onSomeLayouts: the same, where it also matters how the elements of streams are addressed.
//   - onDrawnLayouts: the same for append outputs and scatters, which run.order and the tests on every layout dispatch: their
//     compute programs have barriers, for which the compiler takes much longer.
//   - onEveryLayout: the address arithmetic itself, once for each role of a stream in a call.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"

namespace run_tests {

/// Under the first, extents above 64 are linearised. Under the second, streams of more than 64 elements need several layers.
inline constexpr int smallLimits[] = {64, 8};

/// The device with a profile ("glsl330", "glsl430", "essl300", "native") and its own texture limit (0) or a smaller one. The
/// environment variable SK_TEST_COMPUTE names a profile that takes the place of glsl430, "essl310", and leaves out all other devices
/// of the functions below.
sk::Device& device(std::string_view profile, int textureLimit = 0);

/// A profile with a texture limit.
struct Layout {
  const char* profile;
  int textureLimit;
};

/// Every layout with fragment programs, and whole and layered streams with compute programs. The programs of essl300 are
/// those of glsl330 with another header, but for doubles and more than four outputs (tests/golden/glslang_test.cpp), which have
/// tests of their own. Samplers of layers are the only ones whose precision has no default there; run.layers tests them.
inline constexpr Layout layouts[] = {{"glsl330", 0},
                                     {"glsl330", smallLimits[0]},
                                     {"glsl330", smallLimits[1]},
                                     {"glsl430", 0},
                                     {"glsl430", smallLimits[1]}};

/// A diagonal of targets and addressing: fragment programs with planes and with layers, compute programs with linearised
/// streams. The other combinations put the same functions for elements into the same frames.
inline constexpr Layout someLayouts[] = {
    {"glsl330", 0}, {"glsl330", smallLimits[1]}, {"glsl430", smallLimits[0]}};

/// Fragment programs with planes and with layers.
inline constexpr Layout drawnLayouts[] = {{"glsl330", 0}, {"glsl330", smallLimits[1]}};

/// True on the devices that take full lists of cases: native code, where they cost nothing, and whole planes on GL. The other
/// devices take a sample with a case for each kind of text that the assembler writes.
inline bool takesAllCases(const sk::Device& one) {
  return &one == &device("native") || &one == &device("glsl330");
}

namespace detail {

/// Calls call(test, device) on the chosen layouts and natively, with their names in messages.
void onLayouts(std::span<const Layout> chosen, void (*call)(const void* test, sk::Device& device),
               const void* test);

template <class Test>
void onLayouts(std::span<const Layout> chosen, const Test& test) {
  onLayouts(chosen, [](const void* each, sk::Device& one) { (*static_cast<const Test*>(each))(one); }, &test);
}

}  // namespace detail

/// Calls test(device) on GL and natively: for tests of what a kernel's body computes. essl300 converts no type implicitly.
template <class Test>
void onGlAndNative(const Test& test) {
  constexpr Layout one[] = {{"essl300", 0}};
  detail::onLayouts(one, test);
}

/// Calls test(device) with fragment programs, with compute programs and natively.
template <class Test>
void onEveryTarget(const Test& test) {
  constexpr Layout targets[] = {{"essl300", 0}, {"glsl430", 0}};
  detail::onLayouts(targets, test);
}

/// Calls test(device) on a sample of the layouts, and natively: for tests of calls whose streams may lie anywhere.
template <class Test>
void onSomeLayouts(const Test& test) {
  detail::onLayouts(someLayouts, test);
}

/// Calls test(device) on a sample of the layouts with fragment programs, and natively: for tests of append outputs and of
/// whole algorithms.
template <class Test>
void onDrawnLayouts(const Test& test) {
  detail::onLayouts(drawnLayouts, test);
}

/// Calls test(device) on every layout, and natively: for tests of where elements lie.
template <class Test>
void onEveryLayout(const Test& test) {
  detail::onLayouts(layouts, test);
}

}  // namespace run_tests
