// SPDX-License-Identifier: MIT
//
// The devices that a test program runs on, each opened once: all profiles, and all again with small
// texture limits, under which most shapes are linearised, or lie in several layers; and native code.
#pragma once

#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"

namespace run_tests {

/// Extents above the first are linearised, streams of more than 64 elements layered under the second.
inline constexpr int smallLimits[] = {64, 8};

/// The device of a profile ("glsl330", "glsl430", "essl300", "native"), with its own texture limit (0) or a smaller one.
sk::Device& device(std::string_view profile, int textureLimit = 0);

/// test(device) on every profile: for what a kernel computes.
template <class Test>
void onEveryProfile(const Test& test) {
  for (const std::string profile : {"glsl330", "glsl430", "essl300", "native"}) {
    INFO("profile " << profile);
    test(device(profile));
  }
}

/// A profile with a texture limit.
struct Layout {
  const char* profile;
  int textureLimit;
};

/// Each layout that programs read and write on each stage: most of a test's time goes into the driver's compiler. Programs of
/// essl300 differ from glsl330's by their header and by the precision of what they declare, layers' being the one that has no
/// default: run.layers runs those of every kind.
inline constexpr Layout layouts[] = {{"glsl330", 0},
                                     {"glsl330", smallLimits[0]},
                                     {"glsl330", smallLimits[1]},
                                     {"glsl430", 0},
                                     {"glsl430", smallLimits[1]}};

/// test(device) on every one of the layouts, and natively: for where elements lie.
template <class Test>
void onEveryLayout(const Test& test) {
  for (const Layout& layout : layouts) {
    INFO("profile " << layout.profile << ", texture limit " << layout.textureLimit);
    test(device(layout.profile, layout.textureLimit));
  }
  INFO("native");
  test(device("native"));
}

}  // namespace run_tests
