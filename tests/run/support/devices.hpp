// SPDX-License-Identifier: MIT
//
// The devices that a test program runs on, each opened once: native code, and all profiles, with their own texture limits
// and with small ones, under which most shapes are linearised or need several layers.
#pragma once

#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"

namespace run_tests {

/// Under the first, extents above 64 are linearised. Under the second, streams of more than 64 elements need several layers.
inline constexpr int smallLimits[] = {64, 8};

/// The device with a profile ("glsl330", "glsl430", "essl300", "native") and its own texture limit (0) or a smaller one.
sk::Device& device(std::string_view profile, int textureLimit = 0);

/// Calls test(device) on every profile: for tests of what a kernel computes.
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

/// Every layout with fragment programs, and whole and layered streams with compute programs. Most of a test's time goes
/// into the driver's compiler, so essl300 is left out: its programs differ from those of glsl330 only in the header and in
/// precision qualifiers. Samplers of layers are the only ones without a default precision; run.layers tests them.
inline constexpr Layout layouts[] = {{"glsl330", 0},
                                     {"glsl330", smallLimits[0]},
                                     {"glsl330", smallLimits[1]},
                                     {"glsl430", 0},
                                     {"glsl430", smallLimits[1]}};

/// Calls test(device) on every layout, and natively: for tests of where elements lie.
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
