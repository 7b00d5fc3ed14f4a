// SPDX-License-Identifier: MIT
#include "kernels/operations.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace fuzz {
namespace {

Bound sum(Bound a, Bound b) {
  return {std::max(a.magnitude, b.magnitude) + 1, std::max(a.fraction, b.fraction)};
}
Bound larger(Bound a, Bound b) {
  return {std::max(a.magnitude, b.magnitude), std::max(a.fraction, b.fraction)};
}
Bound product(Bound a, Bound b) { return {a.magnitude + b.magnitude, a.fraction + b.fraction}; }
Bound one(Bound, Bound) { return {0, 0}; }

constexpr FloatOperation floatOperations[] = {
    {"+", [](float a, float b) { return a + b; }, sum},
    {"+", [](float a, float b) { return a + b; }, sum},
    {"-", [](float a, float b) { return a - b; }, sum},
    {"-", [](float a, float b) { return a - b; }, sum},
    {"*", [](float a, float b) { return a * b; }, product},
    {"*", [](float a, float b) { return a * b; }, product},
    {"min", [](float a, float b) { return std::min(a, b); }, larger},
    {"max", [](float a, float b) { return std::max(a, b); }, larger},
    {"step", [](float a, float b) { return b < a ? 0.0F : 1.0F; }, one},
};

using Right = IntOperation::Right;
std::uint32_t plus(std::uint32_t a, std::uint32_t b) { return a + b; }
std::uint32_t minus(std::uint32_t a, std::uint32_t b) { return a - b; }
std::uint32_t times(std::uint32_t a, std::uint32_t b) { return a * b; }
std::uint32_t bitAnd(std::uint32_t a, std::uint32_t b) { return a & b; }
std::uint32_t bitOr(std::uint32_t a, std::uint32_t b) { return a | b; }
std::uint32_t bitXor(std::uint32_t a, std::uint32_t b) { return a ^ b; }
std::uint32_t left(std::uint32_t a, std::uint32_t b) { return a << (b & 31); }
std::uint32_t rightInt(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) >> (b & 31));
}
std::uint32_t rightUint(std::uint32_t a, std::uint32_t b) { return a >> (b & 31); }
// Divisors are small positive constants.
std::uint32_t quotientInt(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) / static_cast<std::int32_t>(b));
}
std::uint32_t quotientUint(std::uint32_t a, std::uint32_t b) { return a / b; }
std::uint32_t restInt(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) % static_cast<std::int32_t>(b));
}
std::uint32_t restUint(std::uint32_t a, std::uint32_t b) { return a % b; }
std::uint32_t leastInt(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b) ? a : b;
}
std::uint32_t mostInt(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b) ? b : a;
}
std::uint32_t leastUint(std::uint32_t a, std::uint32_t b) { return std::min(a, b); }
std::uint32_t mostUint(std::uint32_t a, std::uint32_t b) { return std::max(a, b); }

constexpr IntOperation intOperations[] = {
    {"+", plus, plus, Right::Any},
    {"-", minus, minus, Right::Any},
    {"*", times, times, Right::Any},
    {"&", bitAnd, bitAnd, Right::Any},
    {"|", bitOr, bitOr, Right::Any},
    {"^", bitXor, bitXor, Right::Any},
    {"<<", left, left, Right::Shift},
    {">>", rightInt, rightUint, Right::Shift},
    {"/", quotientInt, quotientUint, Right::Divisor},
    {"%", restInt, restUint, Right::Divisor},
    {"min", leastInt, leastUint, Right::Any},
    {"max", mostInt, mostUint, Right::Any},
};

Bound same(Bound a) { return a; }
Bound whole(Bound a) { return {a.magnitude + 1, 0}; }

constexpr FloatFunction floatFunctions[] = {
    {"-", [](float x) { return -x; }, same},
    {"abs", [](float x) { return std::fabs(x); }, same},
    {"floor", [](float x) { return std::floor(x); }, whole},
    {"ceil", [](float x) { return std::ceil(x); }, whole},
    {"trunc", [](float x) { return std::trunc(x); }, whole},
    {"roundEven", [](float x) { return std::nearbyint(x); }, whole},
    {"fract", [](float x) { return x - std::floor(x); }, [](Bound a) { return Bound{0, a.fraction}; }},
    {"sign", [](float x) { return static_cast<float>((x > 0) - (x < 0)); },
     [](Bound) { return Bound{0, 0}; }},
    {"saturate", [](float x) { return std::min(std::max(x, 0.0F), 1.0F); },
     [](Bound a) { return Bound{0, a.fraction}; }},
};

constexpr IntFunction intFunctions[] = {
    {"-", [](std::uint32_t x) { return 0 - x; }, true},
    {"~", [](std::uint32_t x) { return ~x; }, true},
    {"abs", [](std::uint32_t x) { return static_cast<std::int32_t>(x) < 0 ? 0 - x : x; }, false},
    {"sign",
     [](std::uint32_t x) {
       const auto signed_ = static_cast<std::int32_t>(x);
       return static_cast<std::uint32_t>((signed_ > 0) - (signed_ < 0));
     },
     false},
};

template <class T>
constexpr Comparison comparisonOf(const char* what) {
  return {what, [](float a, float b) { return T()(a, b); },
          [](std::int32_t a, std::int32_t b) { return T()(a, b); },
          [](std::uint32_t a, std::uint32_t b) { return T()(a, b); }};
}
constexpr Comparison comparisons[] = {
    comparisonOf<std::less<>>("<"),      comparisonOf<std::less_equal<>>("<="),
    comparisonOf<std::greater<>>(">"),   comparisonOf<std::greater_equal<>>(">="),
    comparisonOf<std::equal_to<>>("=="), comparisonOf<std::not_equal_to<>>("!=")};

}  // namespace

const FloatOperation& randomFloatOperation(Random& random) { return random.pick(floatOperations); }
const IntOperation& randomIntOperation(Random& random) { return random.pick(intOperations); }
const FloatFunction& randomFloatFunction(Random& random) { return random.pick(floatFunctions); }
const IntFunction& randomIntFunction(Random& random) { return random.pick(intFunctions); }
const Comparison& randomComparison(Random& random) { return random.pick(comparisons); }

}  // namespace fuzz
