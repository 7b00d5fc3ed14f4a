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

/// test(device) on every profile and every texture limit: for where elements lie.
template <class Test>
void onEveryLayout(const Test& test) {
  for (const std::string profile : {"glsl330", "glsl430", "essl300"}) {
    for (const int limit : {0, smallLimits[0], smallLimits[1]}) {
      INFO("profile " << profile << ", texture limit " << limit);
      test(device(profile, limit));
    }
  }
  INFO("native");
  test(device("native"));
}

}  // namespace run_tests
