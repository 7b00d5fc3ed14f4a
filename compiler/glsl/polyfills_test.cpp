// SPDX-License-Identifier: MIT
//
// Promise: the polyfills of scalars compute what C++ computes. Their GLSL is also C++ once the built-ins that
// they call are declared, so it is compiled and run against <cmath>.
//
// Bounds: frexp, ldexp and modf are exact, so results are compared by their bits (NaN as NaN), all on random
// bit patterns, denormals among them (the host keeps them).
#include "glsl/polyfills.hpp"

#include <regex>
#include <string>

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
using std::abs, std::clamp, std::floor, std::isinf, std::max, std::min, std::trunc;
float intBitsToFloat(int i) { return std::bit_cast<float>(i); }
float uintBitsToFloat(uint u) { return std::bit_cast<float>(u); }
int floatBitsToInt(float f) { return std::bit_cast<int>(f); }
uint floatBitsToUint(float f) { return std::bit_cast<uint>(f); }
float mix(float a, float b, bool c) { return c ? b : a; }
float step(float edge, float x) { return x < edge ? 0 : 1; }
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
    const std::string function = withTypes(entry.polyfill, floatType);
    if (function.empty() || function.find("sk_exact_") != std::string::npos)
      continue;  // tests/numerics/sums and dots test vectors
    text += std::regex_replace(function, std::regex(R"(\$[p()])"), "") + "\n";  // without marks of operations
    ++count;
  }
  REQUIRE(count == 9);
  const ToolFolder folder("polyfills");
  folder.write("polyfills.cpp", text + std::string(after));
  CHECK(folder.complaints(std::string(SK_CXX_COMPILER) +
                          " -std=c++20 -O1 polyfills.cpp -o polyfills && ./polyfills") == "");
}

}  // namespace
}  // namespace skc::emit
