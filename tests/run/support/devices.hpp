// SPDX-License-Identifier: MIT
//
// The devices that a test program runs on, each opened once: both profiles, and both again with a
// small texture limit, under which most shapes are linearised.
#pragma once

#include <string>
#include <string_view>

#include <catch2/catch.hpp>

#include "sk/sk.hpp"

namespace run_tests {

/// Extents above this are linearised on the small devices.
inline constexpr int smallLimit = 64;

/// The device of a profile ("glsl330", "essl300"), with the small texture limit or its own.
sk::Device& device(std::string_view profile, bool isSmall = false);

/// test(device) on both profiles: for what a kernel computes.
template <class Test>
void onEveryProfile(const Test& test) {
  for (const std::string profile : {"glsl330", "essl300"}) {
    INFO("profile " << profile);
    test(device(profile));
  }
}

/// test(device) on both profiles and both texture limits: for where elements lie.
template <class Test>
void onEveryLayout(const Test& test) {
  for (const std::string profile : {"glsl330", "essl300"}) {
    for (const bool isSmall : {false, true}) {
      INFO("profile " << profile << (isSmall ? ", linearised above 64" : ""));
      test(device(profile, isSmall));
    }
  }
}

}  // namespace run_tests
