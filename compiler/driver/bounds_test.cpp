// SPDX-License-Identifier: MIT
//
// Promises of --emit=bounds about programs: what of the language has bounds, what has none and why, and what depends on options.
// tests/numerics/fpbench and tests/numerics/bounds compare bounds with the errors of devices.
#include "bounds/bounds.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "driver/compile.hpp"

namespace skc::driver {
namespace bounds_tests {

using bounds::KernelBounds;
using bounds::NumberBound;

std::vector<KernelBounds> boundsOf(const std::string& text, bounds::Options options,
                                   const std::vector<std::string>& ranges) {
  Options driverOptions;
  driverOptions.emit = Emit::Bounds;
  const Translation translation = translateText(driverOptions, "bounded.sk", text);
  INFO(translation.messages);
  REQUIRE(translation.module);
  for (const std::string& range : ranges) options.ranges.push_back(bounds::parseRange(range));
  options.effort = 300'000;
  return bounds::boundsOf(*translation.module, options);
}

/// The first number of the only kernel.
NumberBound boundOf(const std::string& text, const std::vector<std::string>& ranges,
                    const bounds::Options& options = {}) {
  const std::vector<KernelBounds> kernels = boundsOf(text, options, ranges);
  REQUIRE(kernels.size() == 1);
  if (!kernels[0].notBounded.empty())
    return {.name = "", .notBounded = kernels[0].notBounded, .loc = kernels[0].loc};
  return kernels[0].numbers.front();
}

NumberBound ofBody(const std::string& body, const std::vector<std::string>& ranges,
                   const bounds::Options& options = {}) {
  return boundOf("kernel void f(float x<>, float y<>, out float r<>) { " + body + " }", ranges, options);
}

const std::vector<std::string> units = {"x=1:2", "y=1:2"};
constexpr double u = 0x1p-24;

TEST_CASE("straight lines: each operation counts once, with the sign and size that it has") {
  CHECK(ofBody("r = x * y;", units).absolute == Approx(2 * u).epsilon(0.02));
  CHECK(ofBody("r = x + y;", units).absolute == Approx(2 * u).epsilon(0.02));
  CHECK(ofBody("r = x;", units).absolute == 0);
  CHECK(ofBody("r = 2 * x + 0;", units).absolute == 0);
  const NumberBound product = ofBody("r = x * y;", units);
  CHECK(product.range.low == Approx(1));
  CHECK(product.range.high == Approx(4));
  REQUIRE(product.relative);
  CHECK(*product.relative == Approx(u).epsilon(0.02));
  CHECK_FALSE(ofBody("r = x - y;", units).relative);
}

TEST_CASE("a literal that no float is counts by its text") {
  CHECK(ofBody("r = x + 0.1f; r = 0.1f;", units).absolute == 0);  // the float is meant
  CHECK(ofBody("r = 0.1;", units).absolute == Approx(double(0.1F) - 0.1));
  CHECK(ofBody("r = 0.25;", units).absolute == 0);
}

TEST_CASE("a number without a range is named") {
  CHECK(ofBody("r = x * y;", {"x=1:2"}).notBounded == "give y a range: --range 'y=LOW:HIGH'");
  CHECK(ofBody("r = x;", {"x=1:2"}).notBounded.empty());
  const char* const vectors = "kernel void f(float3 v<>, out float r<>) { r = v.x * v.y; }";
  CHECK(boundOf(vectors, {"v.x=1:2"}).notBounded ==
        "give v.y a range: --range v.y=LOW:HIGH, or --range v=LOW:HIGH");
  CHECK(boundOf(vectors, {"v.x=1:2", "v=0:1"}).absolute == Approx(u).epsilon(0.02));
}

TEST_CASE("branches: the side taken counts, and conditions that rounding turns stand apart") {
  const NumberBound sides = ofBody("if (x < 1.5f) r = x * y; else r = x;", units);
  CHECK(sides.absolute == Approx(2 * u).epsilon(0.02));  // below 1.5 * 2
  CHECK(sides.jumps.empty());  // an input has no error
  const NumberBound turned = ofBody("if (x * y < 1.5f) r = x; else r = 8;", units);
  CHECK(turned.absolute == 0);
  REQUIRE(turned.jumps.size() == 1);
  CHECK(turned.jumps[0].text == "x * y < 1.5");
  CHECK(turned.jumps[0].change == Approx(7).epsilon(0.1));
  CHECK(turned.jumps[0].loc.line == 1);
  CHECK(ofBody("r = x > 1 ? log(x - 1) : 0;", {"x=0:1", "y=0"}).absolute == 0);
  const NumberBound choice = ofBody("float t = x * y; r = t > 1 && t < 2 ? t : 1;", units);
  CHECK(choice.absolute == Approx(u).epsilon(0.05));
  const NumberBound magnitude = ofBody("float t = x * y - 1.5f; r = t < 0 ? -t : t;", units);
  CHECK(magnitude.jumps.empty());
  CHECK(magnitude.absolute < 4.1 * u);
  const NumberBound step = ofBody("r = floor(x * y);", units);
  REQUIRE(step.jumps.size() == 1);
  CHECK(step.jumps[0].change == Approx(1).epsilon(0.1));
}

TEST_CASE("loops with known trip counts, breaks, continues and returns") {
  const double four = ofBody("r = 0; for (int i = 0; i < 4; ++i) r += x;", units).absolute;
  CHECK(four == Approx((4 + 4) * u).epsilon(0.05));  // of 3 x and 4 x; 2 x is exact
  CHECK(ofBody("r = 0; for (int i = 0; i < 9; ++i) { if (i == 4) break; r += x; }", units).absolute == four);
  CHECK(ofBody("r = 0; for (int i = 0; i < 8; ++i) { if (i % 2 == 1) continue; r += x; }", units).absolute ==
        four);
  const NumberBound left = ofBody("r = 0; for (int i = 0; i < 4; ++i) { r += x; if (r > 3) break; }", units);
  CHECK(left.absolute < four);
  CHECK(left.jumps.size() == 1);
  const char* const returns =
      "float g(float x) { if (x > 1.5f) return x * x; for (int i = 0; i < 3; ++i) { if (i == 1) return x; } "
      "return 0; }\n"
      "kernel void f(float x<>, out float r<>) { r = g(x); }";
  CHECK(boundOf(returns, {"x=1:1.5"}).absolute == 0);
  CHECK(boundOf(returns, {"x=1:2"}).absolute == Approx(2 * u).epsilon(0.05));
  const NumberBound endless = ofBody("r = x;\nwhile (r > 0.5f) r *= y;", units);
  CHECK(endless.notBounded == "a data-dependent loop: how often it runs depends on numbers that have ranges");
  CHECK(endless.loc.line == 2);
  const char* const counted =
      "kernel void f(int n, float x<>, out float r<>) { r = 0; for (int i = 0; i < n; ++i) r += x; }";
  CHECK(boundOf(counted, {"x=1:2", "n=4"}).absolute == four);
  CHECK(boundOf(counted, {"x=1:2", "n=1:4"}).notBounded ==
        "how often the loop runs depends on n; give it one value: --range n=N");
}

TEST_CASE("switches, helper functions, structs, arrays and vectors") {
  const char* const chosen =
      "kernel void f(int which, float x<>, out float r<>) {\n"
      "  r = x; switch (which) { case 0: r = x * x; break; case 1: r = 2 * x; case 2: r += 1; break; "
      "default: r = 0; } }";
  CHECK(boundOf(chosen, {"x=1:2", "which=0"}).absolute == Approx(2 * u).epsilon(0.02));
  CHECK(boundOf(chosen, {"x=1:2", "which=1"}).absolute == Approx(4 * u).epsilon(0.02));
  CHECK(boundOf(chosen, {"x=1:2", "which=2"}).absolute == Approx(2 * u).epsilon(0.02));
  CHECK(boundOf(chosen, {"x=1:2", "which=3:9"}).absolute == 0);
  CHECK(boundOf(chosen, {"x=1:2", "which=0:9"}).absolute == Approx(4 * u).epsilon(0.1));
  const char* const inOut =
      "void twice(inout float v) { v = v + v; }\n"
      "struct S { float a; float2 b; };\n"
      "kernel void f(S s<>, out float r<>) { float t[3]; for (int i = 0; i < 3; ++i) t[i] = s.b.y * (i + "
      "1);\n"
      "  twice(t[2]); r = t[2] + s.a; }";
  CHECK(boundOf(inOut, {"s.a=0", "s.b.y=1:2"}).absolute == Approx(2 * 4 * u).epsilon(0.1));
  const char* const indexed =
      "kernel void f(int i, float x<>, out float r<>) { float t[3]; t[0] = x; t[1] = x * x; t[2] = 0; r = "
      "t[i]; }";
  CHECK(boundOf(indexed, {"x=1:2", "i=0"}).absolute == 0);
  CHECK(boundOf(indexed, {"x=1:2", "i=0:2"}).absolute == Approx(2 * u).epsilon(0.02));
  const std::vector<KernelBounds> unit =
      boundsOf("kernel void f(float3 v<>, out float3 r<>) { r = normalize(v); }", {}, {"v=1:2"});
  REQUIRE(unit.at(0).numbers.size() == 3);
  CHECK(unit[0].numbers[2].name == "r.z");
  CHECK(unit[0].numbers[2].absolute < 4 * u);
}

TEST_CASE("reads of a gather at equal indices are one number") {
  const auto difference = [](const char* other) {
    return boundOf(
        std::string("kernel void f(float a[], out float r<>) { int i = indexof(r).x; r = a[i + 1] - ") +
            other + "; }",
        {"a=0:1"});
  };
  CHECK(difference("a[i + 1]").range.high == 0);
  CHECK(difference("a[i]").range.high == Approx(1));
}

TEST_CASE("reduces: sums by their known bound, and extremes by that of an element") {
  const char* const sum = "reduce void total(float x<>, reduce float s<>) { s += x * x; }";
  const NumberBound unknown = boundOf(sum, {"x=1:2"});
  CHECK(unknown.notBounded.ends_with("say of how many elements the sum is: --elements N"));
  bounds::Options options;
  options.elements = 1000;
  const NumberBound known = boundOf(sum, {"x=1:2"}, options);
  CHECK(known.range.high == Approx(4000));
  CHECK(known.absolute == Approx(1000 * 2 * u + 4000 * u).epsilon(0.05));
  const char* const largest = "reduce void most(float x<>, reduce float m<>) { m = max(m, x * x); }";
  CHECK(boundOf(largest, {"x=1:2"}).absolute == Approx(2 * u).epsilon(0.05));
  const char* const chosen = "reduce void least(float x<>, reduce float m<>) { if (x * x < m) m = x * x; }";
  CHECK(boundOf(chosen, {"x=1:2"}).absolute == Approx(2 * u).epsilon(0.05));
  // Terms that cancel have been added all the same.
  const char* const cancelling =
      "[[accumulate(tree)]] reduce void rest(float x<>, reduce float s<>) { s = x + (s + 2 - x); }";
  CHECK(boundOf(cancelling, {"x=1000"}, options).absolute > 1000 * 1000 * u);
  const char* const some = "reduce void some(float x<>, reduce float s<>) { if (x > 1.5f) s += x; }";
  CHECK(boundOf(some, {"x=1:2"}, options).range.low == 0);
  const char* const product = "reduce void times(float x<>, reduce float s<>) { s *= x; }";
  CHECK(boundOf(product, {"x=1:2"}, options).notBounded ==
        "the fold neither adds its elements nor takes the smallest or largest of them");
}

TEST_CASE("pushed and scattered numbers, where they are pushed") {
  const std::vector<KernelBounds> pushed = boundsOf(
      "kernel void f(float x<>, vout float r<>) {\n"
      "  if (x > 1) push(r, log(x - 1 + 0.5f));\n"
      "  for (int i = 0; i < 3; ++i)\n"
      "    if (x < 0.5f) push(r, x * i);\n"
      "}",
      {}, {"x=0:2"});
  REQUIRE(pushed.at(0).numbers.size() == 2);
  CHECK(pushed[0].numbers[0].name == "r pushed in line 2");
  CHECK(pushed[0].numbers[0].notBounded == "");  // below 0.5 the logarithm has no value
  CHECK(pushed[0].numbers[0].range.low == Approx(std::log(0.5)).epsilon(0.01));
  CHECK(pushed[0].numbers[1].name == "r pushed in line 4");
  CHECK(pushed[0].numbers[1].range.high == Approx(1).epsilon(0.01));
  const NumberBound added =
      boundOf("kernel void f(int at<>, float x<>, out float r[]) { r[at] += x * x; }", {"x=1:2"});
  CHECK(added.name == "r added in line 1");
  CHECK(added.absolute == Approx(2 * u).epsilon(0.02));
}

TEST_CASE("formulas that cancel: what to write instead, with its bound") {
  const auto rewriteOf = [](const std::string& body, const std::vector<std::string>& ranges,
                            const std::string& to) {
    const NumberBound number = ofBody(body, ranges);
    INFO(body);
    REQUIRE(number.rewrites.size() >= 1);
    CHECK(number.rewrites[0].to == to);
    CHECK(number.rewrites[0].bound <= number.absolute / 2);
  };
  rewriteOf("r = sqrt(x + 1) - sqrt(x);", {"x=1000:10000"}, "(a - b) / (sqrt(a) + sqrt(b))");
  rewriteOf("r = (1 - cos(x)) / (x * x);", {"x=0.001:0.01"}, "2 * sin(x / 2) * sin(x / 2)");
  rewriteOf("r = (exp(x) - 1) / x;", {"x=0.001:0.01"}, "expm1(x)");
  rewriteOf("r = log(1 + x);", {"x=0.001:0.01"}, "log1p(x)");
  rewriteOf("r = x * x - y * y;", {"x=1000:1001", "y=1000:1001"}, "(x - y) * (x + y)");
  rewriteOf("r = (-x + sqrt(x * x - 4 * y)) / 2;", {"x=100:1000", "y=0.1:1"},
            "-2 * c / (b + sqrt(b * b - 4 * a * c))");
  rewriteOf("r = (-x - sqrt(x * x - 4 * y)) / 2;", {"x=-1000:-100", "y=0.1:1"},
            "-2 * c / (b + sqrt(b * b - 4 * a * c))");
  rewriteOf("float m = (x + y) / 2; r = (x * x + y * y) / 2 - m * m;", {"x=1000:1001", "y=1000:1001"},
            "the mean of (x - m) * (x - m)");
  CHECK(ofBody("r = x * y;", units).rewrites.empty());
}

TEST_CASE("what has no bound is said with the reason and the line") {
  const auto reason = [](const std::string& body, const std::vector<std::string>& ranges) {
    return ofBody(body, ranges).notBounded;
  };
  CHECK(reason("r = 1 / (x - y);", units) == "`1.0 / (x - y)` divides by an interval that contains 0");
  CHECK(reason("r = sqrt(x - y);", units) == "`sqrt(x - y)` may be computed where the function has no value");
  CHECK(reason("r = x * 3e38f;", units) == "`x * 3e+38` may overflow");
  CHECK(reason("r = float(asint(x) & 1);", units) == "the function asint");
  CHECK(ofBody("r = 1 / x;", {"x=0:1"}).loc.line == 1);
}

TEST_CASE("precision and target choose the errors of operations") {
  bounds::Options options;
  options.precision = bounds::Precision::Half;
  CHECK(ofBody("r = x * y;", units, options).absolute > 2 * 0x1p-11);
  options.precision = bounds::Precision::Double;
  CHECK(ofBody("r = x * y;", units, options).absolute == Approx(2 * u).epsilon(0.02));  // a float is written
  CHECK(ofBody("r = (x * y - x) * 0x1p-20f;", units, options).absolute < 0x1p-40);
  const char* const declared = "[[precision(half)]] kernel void f(float x<>, out float r<>) { r = x * x; }";
  CHECK(boundOf(declared, {"x=1:2"}).absolute > 2 * 0x1p-11);
  options.precision = bounds::Precision::Single;
  options.isPrecisionGiven = true;
  CHECK(boundOf(declared, {"x=1:2"}, options).absolute < 3 * u);
  CHECK(boundOf(declared, {"x=0.1"}, options).range.low == Approx(double(0.1F) * 0.1F).epsilon(1e-12));
  bounds::Options fragment;
  fragment.target = bounds::Target::Fragment;
  CHECK(ofBody("r = x / y;", units, fragment).absolute > 4 * ofBody("r = x / y;", units).absolute);
  CHECK(ofBody("r = sin(x);", units, fragment).absolute > 3 * ofBody("r = sin(x);", units).absolute);
  const char* const doubles = "kernel void f(double x<>, out double r<>) { r = x * x; }";
  CHECK(boundOf(doubles, {"x=1:2"}).absolute / 0x1p-53 == Approx(2).epsilon(0.02));
}

TEST_CASE("the listing and its JSON say the same") {
  Options options;
  options.emit = Emit::Bounds;
  for (const std::string& range : units) options.bounds.ranges.push_back(bounds::parseRange(range));
  const std::string text = "kernel void f(float x<>, float y<>, out float r<>) { r = x * y; }\n";
  CHECK(compileText(options, "f.sk", text).output ==
        "rounding errors, single precision, native code; inputs are exact\n\n"
        "kernel f\n"
        "  r: 1 to 4, error at most 1.2e-07, relative 6.02e-08\n"
        "    100 % from `x * y` (line 1)\n");
  options.boundsAsJson = true;
  const std::string json = compileText(options, "f.sk", text).output;
  CHECK(json.find("\"name\": \"f\"") != std::string::npos);
  CHECK(json.find("\"contributions\"") != std::string::npos);
}

}  // namespace bounds_tests
}  // namespace skc::driver
