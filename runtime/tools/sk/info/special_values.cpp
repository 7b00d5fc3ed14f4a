// SPDX-License-Identifier: MIT
//
// A table of IEEE 754's results for NaN, infinities, signed zeros and subnormal numbers, compared with the
// device's. Operands are data, so that a compiler cannot fold them.
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "info/device_info.hpp"
#include "info/numbers.hpp"
#include "info/operations.sk.hpp"

namespace sk_tool {

namespace {

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float tiny = 0x1p-130F;  // a subnormal number

enum Operation {
  Transfer,  // written and read back
  Copy,  // copied by a kernel
  Sum,
  Difference,
  Product,
  Quotient,
  Root,
  Least,
  Greatest,
  Tests,  // the first of the bits in operations.sk
  IsEqual = Tests,
  IsLess,
  IsGreater,
  IsUnequal,
  IsNan,
  IsInf,
};

struct Fact {
  std::string_view expression;
  Operation operation;
  float a, b;
  std::string_view ieee;
};

// "d" is 2^-130; min and max are minNum and maxNum of IEEE 754-2008
constexpr Fact facts[] = {
    {"NaN written and read", Transfer, nan, 1, "NaN"},
    {"NaN copied", Copy, nan, 1, "NaN"},
    {"0 / 0", Quotient, 0, 0, "NaN"},
    {"inf - inf", Difference, inf, inf, "NaN"},
    {"0 * inf", Product, 0, inf, "NaN"},
    {"sqrt(-1)", Root, -1, 1, "NaN"},
    {"NaN + 1", Sum, nan, 1, "NaN"},
    {"NaN * 0", Product, nan, 0, "NaN"},
    {"NaN == NaN", IsEqual, nan, nan, "0"},
    {"NaN != NaN", IsUnequal, nan, nan, "1"},
    {"NaN < 1", IsLess, nan, 1, "0"},
    {"NaN > 1", IsGreater, nan, 1, "0"},
    {"isnan(NaN)", IsNan, nan, 1, "1"},
    {"min(NaN, 1)", Least, nan, 1, "1"},
    {"min(1, NaN)", Least, 1, nan, "1"},
    {"max(NaN, 1)", Greatest, nan, 1, "1"},
    {"max(1, NaN)", Greatest, 1, nan, "1"},
    {"inf written and read", Transfer, inf, 1, "inf"},
    {"inf copied", Copy, inf, 1, "inf"},
    {"1 / 0", Quotient, 1, 0, "inf"},
    {"-1 / 0", Quotient, -1, 0, "-inf"},
    {"2^127 * 2", Product, 0x1p127F, 2, "inf"},
    {"isinf(inf)", IsInf, inf, 1, "1"},
    {"-0 written and read", Transfer, -0.0F, 1, "-0"},
    {"-0 copied", Copy, -0.0F, 1, "-0"},
    {"-0 + -0", Sum, -0.0F, -0.0F, "-0"},
    {"0 * -1", Product, 0, -1, "-0"},
    {"1 / -0", Quotient, 1, -0.0F, "-inf"},
    {"sqrt(-0)", Root, -0.0F, 1, "-0"},
    {"min(0, -0)", Least, 0, -0.0F, "-0"},
    {"min(-0, 0)", Least, -0.0F, 0, "-0"},
    {"d written and read", Transfer, tiny, 1, "7.347e-40"},
    {"d copied", Copy, tiny, 1, "7.347e-40"},
    {"d + 0", Sum, tiny, 0, "7.347e-40"},
    {"d * 2^24", Product, tiny, 0x1p24F, "1.233e-32"},
    {"2^-100 * 2^-30", Product, 0x1p-100F, 0x1p-30F, "7.347e-40"},
    {"2^-125 - 1.5 * 2^-126", Difference, 0x1p-125F, 0x1.8p-126F, "5.877e-39"},
    {"sqrt(d)", Root, tiny, 1, "2.711e-20"},
    {"d == 0", IsEqual, tiny, 0, "0"},
    {"d > 0", IsGreater, tiny, 0, "1"},
    {"min(d, 1)", Least, tiny, 1, "7.347e-40"},
    {"max(d, 0)", Greatest, tiny, 0, "7.347e-40"},
};

std::string text(float value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (value == 0) return std::signbit(value) ? "-0" : "0";
  return fmt::format("{:.4g}", value);
}

/// The results of all operations on the operands of all facts.
class SpecialResults {
 public:
  explicit SpecialResults(sk::Device& device) {
    std::vector<float> as;
    std::vector<float> bs;
    for (const Fact& fact : facts) {
      as.push_back(fact.a);
      bs.push_back(fact.b);
    }
    auto a = streamOf(device, as);
    auto b = streamOf(device, bs);
    std::vector<sk::Stream<float>> r;
    for (int i = 0; i < Tests; ++i) r.push_back(device.stream<float>(a.shape()));
    auto tests = device.stream<unsigned>(a.shape());
    constexpr sk::CallOptions fast{.intrinsics = sk::Intrinsics::Fast};
    probes::copy.with(fast)(a, r[Copy]);
    probes::arithmetic.with(fast)(a, b, r[Sum], r[Difference], r[Product], r[Quotient], r[Root]);
    probes::extremes.with(fast)(a, b, r[Least], r[Greatest], tests);
    values_.push_back(a.read());
    for (int i = Copy; i < Tests; ++i) values_.push_back(r[static_cast<std::size_t>(i)].read());
    tests_ = tests.read();
  }
  std::string of(std::size_t fact) const {
    const Operation operation = facts[fact].operation;
    if (operation < Tests) return text(values_[operation][fact]);
    return (tests_[fact] >> (operation - Tests) & 1U) != 0 ? "1" : "0";
  }

 private:
  std::vector<std::vector<float>> values_;
  std::vector<unsigned> tests_;
};

}  // namespace

Json probeSpecialValues(sk::Device& device) {
  const SpecialResults results(device);
  Json list = Json::array();
  for (std::size_t i = 0; i < std::size(facts); ++i) {
    list.push_back(
        {{"expression", facts[i].expression}, {"gives", results.of(i)}, {"ieee_754", facts[i].ieee}});
  }
  return list;
}

}  // namespace sk_tool
