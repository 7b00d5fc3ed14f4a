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
  REQUIRE(findProfile("essl310") != nullptr);
  CHECK(findProfile("essl310")->stage == Stage::Compute);
  CHECK(findProfile("essl310")->es);
  REQUIRE(findProfile("webgl2") != nullptr);
  CHECK(findProfile("webgl2")->webgl);
  CHECK(findProfile("webgl2")->version == findProfile("essl300")->version);
  CHECK(findProfile("glsl") == nullptr);
  for (const Profile& profile : profiles()) CHECK(findProfile(profile.name) == &profile);
}

TEST_CASE("compute programs of ES write images of four components, or of one of 32 bits") {
  Profile es = *findProfile("essl310");
  CHECK(imageFormat({"", sk::program::Scalar::Float, 3, 0}) == "rgba32f");
  CHECK(imageFormat({"", sk::program::Scalar::Double, 1, 0}) == "rg32ui");
  CHECK(imageFormat({"", sk::program::Scalar::Snorm16, 1, 0}) == "r16i");
  for (const char* format : {"r32f", "r32i", "r32ui", "rgba8", "rgba8i", "rgba16f", "rgba16ui", "rgba32i"})
    CHECK(mayStore(es, format));
  constexpr const char* others[] = {"rg32f", "rg8ui", "rg16i", "r8", "r8ui", "r16f", "r16i"};
  for (const char* format : others) {
    CHECK_FALSE(mayStore(es, format));
    CHECK(mayStore(*findProfile("glsl430"), format));
  }
  es.storesAllFormats = true;
  for (const char* format : others) CHECK(mayStore(es, format));
}
