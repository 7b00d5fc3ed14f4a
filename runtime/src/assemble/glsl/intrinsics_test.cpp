// SPDX-License-Identifier: MIT
//
// Promises: only what a kernel uses is defined, each once and after what it needs; every intrinsic has both
// variants for every width. (glslang_test.cpp compiles all of them with glslang, tests/numerics measures
// them.)
#include "assemble/glsl/intrinsics.hpp"

#include <array>
#include <string>

#include <catch2/catch.hpp>

#include "occurrences.hpp"

using namespace sk::assemble;
using sk::program::Intrinsic;
using sk::program::IntrinsicUse;

namespace {

TEST_CASE("nothing is defined for a kernel without intrinsics") {
  CHECK(intrinsicTexts({}, true).definitions.empty());
  CHECK(intrinsicTexts({}, false).definitions.empty());
}

TEST_CASE("the device's own functions under our names") {
  const std::array uses = {IntrinsicUse{Intrinsic::Atan2, 1}, IntrinsicUse{Intrinsic::Isnan, 4}};
  const IntrinsicTexts texts = intrinsicTexts(uses, false);
  CHECK(texts.definitions == R"(
float sk_atan2(float x, float y) { return atan(x, y); }
bvec3 sk_isnan(vec3 x) { return isnan(x); }
)");
  CHECK_FALSE(texts.useExactFloats);
}

TEST_CASE("functions that devices lack are ours in fast calls, too") {
  const std::array uses = {IntrinsicUse{Intrinsic::Erf, 0b10}, IntrinsicUse{Intrinsic::Exp, 1}};
  const IntrinsicTexts texts = intrinsicTexts(uses, false);
  CHECK(occurrences(texts.definitions, "float sk_erfc_part(float a) {") == 1);
  CHECK(occurrences(texts.definitions, "vec2 sk_erf(vec2 x) {") == 1);
  CHECK(occurrences(texts.definitions, "float sk_exp(float x) { return exp(x); }") == 1);
  CHECK(texts.useExactFloats);
}

TEST_CASE("accurate functions come with what they need, once") {
  const std::array uses = {IntrinsicUse{Intrinsic::Log, 1}, IntrinsicUse{Intrinsic::Asinh, 0b1010}};
  const std::string text = intrinsicTexts(uses, true).definitions;
  CHECK(occurrences(text, "float sk_log(float x) {") == 1);
  CHECK(occurrences(text, "float sk_asinh(float x) {") == 1);
  CHECK(occurrences(text, "vec2 sk_asinh(vec2 x) {") == 1);
  CHECK(occurrences(text, "vec3 sk_asinh(") == 0);
  CHECK(occurrences(text, "vec4 sk_asinh(vec4 x) {") == 1);
  CHECK(text.find("sk_log_tail(float f)") < text.find("float sk_log(float x)"));
  CHECK(text.find("float sk_log(float x)") < text.find("float sk_asinh(float x)"));
  CHECK(occurrences(text, "sk_reduce") == 0);
}

TEST_CASE("every intrinsic has both forms, of every width") {
  for (int i = 0; i <= static_cast<int>(Intrinsic::Normalize); ++i) {
    const IntrinsicUse use{static_cast<Intrinsic>(i), 0b1111};
    const std::string called = " " + std::string(name(use.intrinsic)) + "(";
    INFO(called);
    for (const std::string_view type : {"float ", "vec2 ", "vec3 ", "vec4 "}) {
      const std::string head = called + std::string(type);
      CHECK(occurrences(intrinsicTexts({&use, 1}, false).definitions, head) == 1);
      CHECK(occurrences(intrinsicTexts({&use, 1}, true).definitions, head) == 1);
    }
  }
}

TEST_CASE("barriers are asked for where a text has them") {
  const auto needs = [](Intrinsic intrinsic) {
    const IntrinsicUse use{intrinsic, 1};
    return intrinsicTexts({&use, 1}, true).useExactFloats;
  };
  CHECK(needs(Intrinsic::Pow));
  CHECK(needs(Intrinsic::Sin));
  CHECK(needs(Intrinsic::Mix));
  CHECK(needs(Intrinsic::Log1p));
  CHECK_FALSE(needs(Intrinsic::Min));
  CHECK_FALSE(needs(Intrinsic::Log));
}

}  // namespace
