// SPDX-License-Identifier: MIT
//
// Promises: a program defines exactly the functions of doubles that its kernel calls, each once and after
// what it needs; glslang accepts all of them in every representation. (tests/numerics measures them.)
#include "assemble/glsl/double_intrinsics.hpp"

#include <array>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "occurrences.hpp"

#include "assemble/glsl/intrinsics.hpp"

using namespace sk::assemble;
using sk::program::Intrinsic;
using sk::program::IntrinsicUse;

namespace {

std::string definitions(const std::vector<IntrinsicUse>& uses, Doubles form = Doubles::Pairs) {
  return doubleIntrinsicDefinitions(uses, form, sk::Barrier::Xor);
}

TEST_CASE("functions of doubles come with what they need, once") {
  CHECK(definitions({}).empty());
  CHECK(definitions({{Intrinsic::Sin, 0b1111}}).empty());  // functions of floats
  const std::string text = definitions({{Intrinsic::Log, 1, true}, {Intrinsic::Asinh, 0, true}});
  CHECK(occurrences(text, "sk_double sk_log(sk_double x) {") == 1);
  CHECK(occurrences(text, "sk_double sk_asinh(sk_double x) {") == 1);
  CHECK(occurrences(text, "sk_double sk_log_tail(sk_double f) {") == 1);
  CHECK(text.find("sk_double sk_log_plus(") < text.find("sk_double sk_asinh("));
  CHECK(occurrences(text, "sk_exp_") == 0);
  CHECK(occurrences(text, "sk_two_over_pi_bits") == 0);
}

TEST_CASE("what is called with doubles alone is not defined for floats") {
  const std::array uses = {IntrinsicUse{Intrinsic::Exp, 0, true}};
  CHECK(intrinsicTexts(uses, true).definitions.empty());
  CHECK(intrinsicTexts(uses, false).definitions.empty());
  const std::array both = {IntrinsicUse{Intrinsic::Exp, 0, true}, IntrinsicUse{Intrinsic::Log, 1}};
  CHECK(occurrences(intrinsicTexts(both, true).definitions, "sk_exp") == 0);
}

TEST_CASE("constants are exact in either form") {
  CHECK(doubleConstant(Doubles::Native, 0.5) == "sk_double(uvec2(0x00000000u, 0x3fe00000u))");
  CHECK(doubleConstant(Doubles::Pairs, 1 + 0x1p-30) == "sk_double(1.00000000, 9.31322575e-10)");
  CHECK(withConstants(Doubles::Pairs, "sk_add(D(1.0), mad(x))") ==
        "sk_add(sk_double(1.00000000, 0.00000000), mad(x))");
}

TEST_CASE("a polynomial has coefficients of pairs only where they matter") {
  static constexpr double one[] = {0.5, 0.25, 0.125}, other[] = {1.5, 1.25, 1.125};
  CHECK(polynomialText(Doubles::Native, {"sk_p", 1, one}) ==
        "sk_double sk_p(sk_double x) {\n"
        "  double y = sk_value(x), p = 0.12500000000000000lf;\n"
        "  p = p * y + 0.25000000000000000lf;\n"
        "  p = p * y + 0.50000000000000000lf;\n"
        "  return sk_of(p);\n"
        "}\n");
  CHECK(polynomialText(Doubles::Pairs, {"sk_p", 1, one, other}) ==
        "sk_double sk_p(sk_double x, bool other) {\n"
        "  float t = (other ? 1.12500000 : 0.125000000);\n"
        "  t = t * x.hi + (other ? 1.25000000 : 0.250000000);\n"
        "  sk_double p = sk_to_double(t);\n"
        "  p = sk_step(p, x, sk_choose(other, sk_double(1.50000000, 0.00000000), sk_double(0.500000000, "
        "0.00000000)));\n"
        "  return p;\n"
        "}\n");
  CHECK(polynomialText(Doubles::Pairs, {"sk_p", 1, one, {}, true}) ==
        "sk_double sk_p(sk_double x) {\n"
        "  float t = 0.125000000;\n"
        "  t = t * x.hi + 0.250000000;\n"
        "  sk_double p = sk_to_double(t);\n"
        "  p = sk_add(sk_mul(p, x), sk_double(0.500000000, 0.00000000));\n"
        "  return p;\n"
        "}\n");
}

}  // namespace
