// SPDX-License-Identifier: MIT
#include "support/verification.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace examples {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST_CASE("the largest error and its place are kept") {
  Verification v("sums", 0.1, "made up");
  v.compare(3, 1.0, 1.0);
  v.compare(4, 1.05, 1.0);
  v.compare(5, 2.02, 2.0);
  CHECK(v.largest() == Approx(0.05));
  CHECK(v.passed());
  CHECK(v.text() == "sums: largest error 0.05 at 4 of 3, allowed 0.1 (made up): ok");
  v.compare(6, 30.0, 10.0, 100.0);
  CHECK(v.largest() == Approx(0.2));
  CHECK_FALSE(v.passed());
}

TEST_CASE("what is not finite") {
  Verification v("sums", 1e300, "made up");
  v.compare(0, infinity, infinity);
  v.compare(1, NAN, NAN);
  CHECK(v.largest() == 0.0);
  SECTION("NaN for a number") { v.compare(2, NAN, 1.0); }
  SECTION("a number for NaN") { v.compare(2, 1.0, NAN); }
  SECTION("the other infinity") { v.compare(2, infinity, -infinity); }
  SECTION("any difference where the scale is 0") { v.compare(2, 1.0, 2.0, 0.0); }
  CHECK(v.largest() == infinity);
  CHECK_FALSE(v.passed());
}

TEST_CASE("nothing compared is nothing verified") {
  const Verification v("sums", 1.0, "made up");
  CHECK_FALSE(v.passed());
  CHECK(v.text() == "sums: nothing was compared: FAILED");
}

TEST_CASE("the bound of a sum grows with the passes") {
  CHECK(sumBound(1) == 31 * roundoff);
  CHECK(sumBound(32) == 31 * roundoff);
  CHECK(sumBound(33) == 2 * 31 * roundoff);
  CHECK(sumBound(1 << 20) == 4 * 31 * roundoff);
}

}  // namespace
}  // namespace examples
