// SPDX-License-Identifier: MIT
//
// Promises: how ranges are written, and which of them a number gets.
#include "bounds/options.hpp"

#include <catch2/catch.hpp>

namespace skc::bounds {
namespace {

TEST_CASE("ranges are read, or refused with what to write") {
  const NamedRange range = parseRange("v.x=-1.5:2e3");
  CHECK(range.name == "v.x");
  CHECK(range.low == -1.5);
  CHECK(range.high == 2000);
  const NamedRange one = parseRange("n=8");
  CHECK((one.low == 8 && one.high == 8));
  CHECK_THROWS_WITH(parseRange("x"), "'x' is not a range; write NAME=LOW:HIGH");
  CHECK_THROWS_WITH(parseRange("=1:2"), "'=1:2' is not a range; write NAME=LOW:HIGH");
  CHECK_THROWS_WITH(parseRange("x=2:1"), "'x=2:1' ends before it begins; write the lower end first");
  CHECK_THROWS_WITH(parseRange("x=1:"), "'' in 'x=1:' is not a finite number");
  CHECK_THROWS_WITH(parseRange("x=0:inf"), "'inf' in 'x=0:inf' is not a finite number");
}

TEST_CASE("the longest name given counts, and of equal ones the last") {
  Options options;
  for (const char* text : {"v=0:1", "v.x=2:3", "m=0:1", "m[0][1]=5:6", "m=1:2"})
    options.ranges.push_back(parseRange(text));
  const ir::KernelParam param{};
  const auto low = [&](std::string_view name) { return rangeOf(options, param, name)->low; };
  CHECK(low("v.x") == 2);
  CHECK(low("v.y") == 0);
  CHECK(low("m[0][1]") == 5);
  CHECK(low("m[1][1]") == 1);
  CHECK(!rangeOf(options, param, "w"));
}

TEST_CASE("a declared range counts where the command line gives none") {
  ir::KernelParam param{};
  param.name = "v";
  param.range = ir::ValueRange{0, 0.1};
  Options options;
  CHECK(rangeOf(options, param, "v.x")->high == 0.1F);  // above 0.1, as a stream of floats holds it
  CHECK(!rangeOf(options, param, "indexof(v)"));
  options.ranges.push_back(parseRange("v.y=2:3"));
  CHECK(rangeOf(options, param, "v.y")->low == 2);
  CHECK(rangeOf(options, param, "v.x")->low == 0);
}

}  // namespace
}  // namespace skc::bounds
