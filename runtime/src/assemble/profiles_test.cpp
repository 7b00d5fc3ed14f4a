// SPDX-License-Identifier: MIT
#include <catch2/catch.hpp>

#include "assemble/assemble.hpp"

using namespace sk::assemble;

TEST_CASE("profiles are found by name") {
  REQUIRE(findProfile("glsl330") != nullptr);
  CHECK(findProfile("glsl330")->drawBuffers == 8);
  REQUIRE(findProfile("essl300") != nullptr);
  CHECK(findProfile("essl300")->es);
  REQUIRE(findProfile("glsl430") != nullptr);
  CHECK(findProfile("glsl430")->stage == Stage::Compute);
  REQUIRE(findProfile("webgl2") != nullptr);
  CHECK(findProfile("webgl2")->webgl);
  CHECK(findProfile("webgl2")->version == findProfile("essl300")->version);
  CHECK(findProfile("glsl") == nullptr);
  for (const Profile& profile : profiles()) CHECK(findProfile(profile.name) == &profile);
}
