// SPDX-License-Identifier: MIT
#include "stress/cases.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

using namespace sk_tool::stress;

namespace {

std::vector<std::string> textsOf(const std::vector<Given>& given, const std::vector<std::string>& only = {}) {
  std::vector<std::string> texts;
  for (const Case& each : valueCases(given, only)) texts.push_back(each.text);
  return texts;
}

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("a declared range gives its ends, and what it has of zero and tiny numbers") {
  Given given{.kernel = "heat::step", .parameter = "dt", .scalar = "float", .low = 0.25, .high = 0.25};
  given.range = Range{0, 0.5};
  CHECK(textsOf({given}) == Texts{"heat::step.dt = 0, the lower end of its range",
                                  "heat::step.dt = 0.5, the upper end of its range",
                                  "heat::step.dt = 1.17549435e-38, tiny, in its range"});
  given.range = Range{-1, 0.25};
  CHECK(textsOf({given}) == Texts{"heat::step.dt = -1, the lower end of its range",
                                  "heat::step.dt = 0, in its range",
                                  "heat::step.dt = 1.17549435e-38, tiny, in its range"});
  given.range = Range{1, 1.0 / 0.0};
  CHECK(textsOf({given}) == Texts{"heat::step.dt = 1, the lower end of its range",
                                  "heat::step.dt = 3.40282347e+38, the largest number in its range"});
  for (const Case& each : valueCases({given}, {})) CHECK(each.mustHold);
}

TEST_CASE("without a range, numbers are zero, tiny and huge, and one element of a stream is NaN") {
  const Given value{.kernel = "a::k", .parameter = "x", .scalar = "half", .low = 1, .high = 2};
  CHECK(textsOf({value}) == Texts{"a::k.x = 0", "a::k.x = 6.10351562e-05, tiny", "a::k.x = 65504, huge",
                                  "a::k.x = -65504, huge"});
  Given stream{.kernel = "a::k", .parameter = "u", .scalar = "float", .isStream = true, .low = 0, .high = 0};
  stream.elements = 9;
  const std::vector<Case> cases = valueCases({stream}, {});
  REQUIRE(cases.size() == 4);  // it is 0 anyway
  CHECK(cases[0].text == "a::k.u = 1.17549435e-38 everywhere, tiny");
  CHECK(cases[0].settings == Texts{"a::k.u:1.1754943508222875e-38"});
  CHECK(cases[3].text == "a::k.u[4] = nan");
  CHECK(cases[3].settings == Texts{"a::k.u[4]:nan"});
  CHECK(cases[3].hasNan);
  for (const Case& each : cases) CHECK_FALSE(each.mustHold);
}

TEST_CASE("integers are not huge unless a range says so, and booleans stay") {
  Given count{.kernel = "a::k", .parameter = "n", .scalar = "int", .low = 8, .high = 8};
  CHECK(textsOf({count}) == Texts{"a::k.n = 0", "a::k.n = 1"});
  count.range = Range{1, 1000000};
  CHECK(textsOf({count}) ==
        Texts{"a::k.n = 1, the lower end of its range", "a::k.n = 1000000, the upper end of its range"});
  CHECK(textsOf({{.kernel = "a::k", .parameter = "b", .scalar = "bool", .low = 0, .high = 1}}).empty());
  const Given colour{.kernel = "a::k", .parameter = "c", .scalar = "unorm", .low = 0, .high = 1};
  CHECK(textsOf({colour}) == Texts{"a::k.c = 0", "a::k.c = 1.52587891e-05, tiny", "a::k.c = 1, huge"});
}

TEST_CASE("values that several kernels are given alike change together") {
  const auto dt = [](const char* kernel, double value) {
    return Given{.kernel = kernel, .parameter = "dt", .scalar = "int", .low = value, .high = value};
  };
  const std::vector<Case> two = valueCases({dt("a::x", 1), dt("a::y", 1), dt("a::z", 2)}, {});
  REQUIRE(two.size() == 3);
  CHECK(two[0].text == "dt of a::x and a::y = 0");
  CHECK(two[0].settings == Texts{"a::x.dt:0", "a::y.dt:0"});
  CHECK(two[1].text == "a::z.dt = 0");
  const std::vector<Case> four = valueCases({dt("a::w", 1), dt("a::x", 1), dt("a::y", 1), dt("a::z", 1)}, {});
  REQUIRE(four.size() == 1);
  CHECK(four[0].text == "dt of a::w, a::x and 2 others = 0");
  CHECK(textsOf({dt("a::x", 1), dt("b::y", 1)}, {"b::*"}) == Texts{"b::y.dt = 0"});
  CHECK(textsOf({dt("a::x", 1), dt("b::y", 1)}, {"a::x.dt"}) == Texts{"a::x.dt = 0"});
}

TEST_CASE("sizes are in braces") {
  CHECK(hasSize("--size={256}"));
  CHECK_FALSE(hasSize("--size={}"));
  CHECK_FALSE(hasSize("{a}{12"));
  CHECK(withSize("--size={256}", 17) == "--size=17");
  CHECK(withSize("{8}x{16},{a}", 3) == "3x3,{a}");
  CHECK(withSize("{8}x{16}", 0) == "8x16");
  CHECK(withSize("{{7}}", 1) == "{1}");
}
