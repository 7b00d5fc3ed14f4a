// SPDX-License-Identifier: MIT
//
// Promise: the polyfills of scalars compute what C++ computes. Their GLSL is also C++ once the built-ins that
// they call are declared, so it is compiled and run against <cmath>.
//
// Bounds: frexp, ldexp and modf are exact, so results are compared by their bits (NaN as NaN), all on random
// bit patterns, denormals among them (the host keeps them). Functions of integers are exact, with GLSL 4.00's functions and without.
#include "glsl/polyfills.hpp"

#include <regex>
#include <string>

#include <fmt/format.h>
#include <catch2/catch.hpp>

#include "glsl/tool_folder.hpp"
#include "ir/kernel_builder.hpp"

namespace skc::emit {
namespace {

using namespace ir;

constexpr std::string_view before = R"(
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <random>
using uint = std::uint32_t;
#undef __VERSION__
#define __VERSION__ SK_GLSL
using std::abs, std::clamp, std::floor, std::isinf, std::max, std::min, std::trunc;
float intBitsToFloat(int i) { return std::bit_cast<float>(i); }
float uintBitsToFloat(uint u) { return std::bit_cast<float>(u); }
int floatBitsToInt(float f) { return std::bit_cast<int>(f); }
uint floatBitsToUint(float f) { return std::bit_cast<uint>(f); }
float mix(float a, float b, bool c) { return c ? b : a; }
float step(float edge, float x) { return x < edge ? 0 : 1; }
int bitCount(uint x) { return std::popcount(x); }
int findMSB(uint x) { return 31 - std::countl_zero(x); }
int findLSB(uint x) { return x == 0 ? -1 : std::countr_zero(x); }
void umulExtended(uint a, uint b, uint& high, uint& low) {
  const std::uint64_t product = std::uint64_t(a) * b;
  high = uint(product >> 32);
  low = uint(product);
}
void imulExtended(int a, int b, int& high, int& low) {
  const std::int64_t product = std::int64_t(a) * b;
  high = int(product >> 32);
  low = int(product);
}
#define sk_precise
#define sk_keep(x) (x)
)";

constexpr std::string_view after = R"(
int wrong = 0;
void same(const char* what, float x, float y, float got, float wanted) {
  const bool equal = std::isnan(wanted) ? std::isnan(got) : floatBitsToUint(got) == floatBitsToUint(wanted);
  if (!equal && ++wrong < 20) std::printf("%s(%a, %a) = %a, not %a\n", what, x, y, got, wanted);
}
void check(float x, int e) {
  int exponent = 0;
  const float mantissa = std::frexp(x, &exponent);
  if (!std::isfinite(x)) exponent = 0;
  same("frexp exponent", x, 0, float(sk_frexp_exponent(x)), float(exponent));
  same("frexp mantissa", x, 0, sk_frexp_mantissa(x), mantissa);
  const float scaled = std::ldexp(x, e);
  if (scaled == 0 || !std::isfinite(scaled) || std::isnormal(scaled)) same("ldexp", x, float(e), sk_ldexp(x, e), scaled);
  float whole = 0;
  same("modf", x, 0, sk_modf_fraction(x), std::modf(x, &whole));
}
void sameBits(const char* what, uint x, uint y, uint got, uint wanted) {
  if (got != wanted && ++wrong < 20) std::printf("%s(%x, %x) = %x, not %x\n", what, x, y, got, wanted);
}
void checkBits(uint x, uint y) {
  sameBits("popcount", x, 0, uint(sk_popcount(x)), uint(std::popcount(x)));
  sameBits("popcount of int", x, 0, uint(sk_popcount(int(x))), uint(std::popcount(x)));
  sameBits("clz", x, 0, uint(sk_clz(x)), uint(std::countl_zero(x)));
  sameBits("clz of int", x, 0, uint(sk_clz(int(x))), uint(std::countl_zero(x)));
  sameBits("ctz", x, 0, uint(sk_ctz(x)), uint(std::countr_zero(x)));
  sameBits("ctz of int", x, 0, uint(sk_ctz(int(x))), uint(std::countr_zero(x)));
  sameBits("mulhi", x, y, sk_mulhi(x, y), uint(std::uint64_t(x) * y >> 32));
  sameBits("mulhi of int", x, y, uint(sk_mulhi(int(x), int(y))), uint(std::int64_t(int(x)) * int(y) >> 32));
}
void checkSum(float x, float y) {   // a double holds the sum of floats whose exponents are near
  const float sum = sk_rounded_sum(x, y);
  same("sum", x, y, sum, x + y);
  const float error = sk_sum_error(x, y);
  same("error of a sum", x, y, std::isfinite(error) ? error : NAN, std::isfinite(sum) ? float((double(x) + y) - sum) : NAN);
}
void checkProduct(float x, float y) {   // a double holds the product of floats
  const float product = x * y;
  same("error of a product", x, y, 0 + sk_product_error(x, y), 0 + float(double(x) * y - product));   // any 0
}
int main() {
  std::mt19937 random(7);
  const uint patterns[] = {0u, 1u, 2u, 3u, 0x7fffffffu, 0x80000000u, 0x80000001u, 0xfffffffeu, 0xffffffffu, 0x00ffffffu, 0x01ffffffu};
  for (uint x : patterns) {
    for (uint y : patterns) checkBits(x, y);
  }
  for (int i = 0; i < 1000000; ++i) checkBits(random() >> (i & 31), random() >> (i >> 5 & 31));
  std::uniform_real_distribution<float> number(-100000, 100000);
  for (int i = 0; i < 100000; ++i) checkSum(number(random), number(random));
  for (int i = 0; i < 100000; ++i) checkProduct(number(random), number(random));
  for (int i = 0; i < 1000000; ++i) {   // factors of all sizes, whose product is one of floats
    const auto mantissa = [&] { return uintBitsToFloat((random() & 0x807fffffu) | 0x3f800000u); };
    const int a = int(random() % 254) - 126, sum = int(random() % 227) - 100, b = sum - a;
    if (b >= -126 && b <= 127) checkProduct(std::ldexp(mantissa(), a), std::ldexp(mantissa(), b));
  }
  for (float x : {0.0f, 3e38f, INFINITY, -INFINITY, NAN}) checkSum(x, 3e38f);
  for (int i = 0; i < 2000000; ++i) check(uintBitsToFloat(random()), int(random() % 700) - 350);
  const float special[] = {0.0f, -0.0f, INFINITY, -INFINITY, NAN, 1.0f, -1.0f, 0.5f, 1e-45f, 1.17549421e-38f, 3.4028235e38f};
  for (float x : special) {
    for (int e = -400; e <= 400; ++e) check(x, e);
  }
  return wrong;
}
)";

TEST_CASE("polyfills compute what C++ computes") {
  std::string text(before);
  int count = 0;
  for (const IntrinsicRow& entry : intrinsicRows()) {
    if (entry.polyfill.empty() || entry.polyfill.find("sk_exact_") != std::string::npos)
      continue;  // tests/numerics/sums and dots test vectors
    for (const IntrinsicOverload& overload : overloads(entry.id)) {
      const Type argument = overload.arguments[0];
      if (!argument.isScalar() || argument.is64Bit()) continue;
      const std::string function = withTypes(entry.polyfill, argument);
      text +=
          std::regex_replace(function, std::regex(R"(\$[p()])"), "") + "\n";  // without marks of operations
      ++count;
    }
  }
  REQUIRE(count == 17);
  const ToolFolder folder("polyfills");
  folder.write("polyfills.cpp", text + std::string(after));
  for (const char* version : {"330", "430"}) {
    INFO(version);
    CHECK(folder.complaints(
              fmt::format("{} -std=c++20 -O1 -DSK_GLSL={} polyfills.cpp -o polyfills && ./polyfills",
                          SK_CXX_COMPILER, version)) == "");
  }
}

}  // namespace
}  // namespace skc::emit
