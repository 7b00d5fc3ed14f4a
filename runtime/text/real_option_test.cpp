// SPDX-License-Identifier: MIT
#include "text/real_option.hpp"

#include <catch2/catch.hpp>

namespace sk::text {

TEST_CASE("checks of real numbers on command lines") {
  const auto part = realFrom(0, 1);
  for (const char* const text : {"0", "1", "0.5", "1e-300", "0x1p-3"}) CHECK(part(text).empty());
  for (const char* const text : {"", "-1e-9", "1.1", "nan", "inf", "-inf", "x", "0.5x", "1e400"})
    CHECK_FALSE(part(text).empty());
  CHECK(part("-1") == "'-1' is no number from 0 to 1");
  CHECK(realFrom(1e-12, 1e12)("0") == "'0' is no number from 1e-12 to 1e+12");
  CHECK(aboveZero()("1e-310").empty());  // denormal, and above 0
  CHECK(aboveZero()("1e-400") == "'1e-400' is no number above 0; give one such as 1e-5");
  CHECK(zeroOrAbove()("0").empty());
  CHECK_FALSE(zeroOrAbove()("-0.1").empty());
}

}  // namespace sk::text
