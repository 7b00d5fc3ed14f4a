// SPDX-License-Identifier: MIT
#include "ir/quantize.hpp"

#include <bit>
#include <cassert>
#include <cmath>

#include "ir/build.hpp"

namespace skc::ir {
namespace {

float nearestHalf(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  if (magnitude > 0x7f800000U) return x;
  std::uint32_t rounded = (magnitude + 0xfffU + ((magnitude >> 13) & 1U)) & 0xffffe000U;
  if (rounded > 0x477fe000U) rounded = 0x7f800000U;
  if (magnitude < 0x38800000U) {   // half would be subnormal: a multiple of 2^-24
    const float steps = std::bit_cast<float>(magnitude) * 0x1p24F;
    rounded = std::bit_cast<std::uint32_t>(std::nearbyint(steps) * 0x1p-24F);
  }
  return std::bit_cast<float>((bits & 0x80000000U) | rounded);
}

float nearestNormalized(float x, float least, float scale) {
  if (std::isnan(x)) return 0;
  if (x <= least) return least;
  return x >= 1 ? 1.0F : std::nearbyint(x * scale) / scale;
}

}  // namespace

float normalizedScale(Scalar narrow) {
  assert(row(narrow).one > 0 && "not a normalized scalar");
  return row(narrow).one;
}

float roundedToOdd(double value) {
  const auto nearest = static_cast<float>(value);
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  if (std::isnan(value) || double{nearest} == value || (bits & 1U) != 0) return nearest;
  const bool isBeyond = std::fabs(double{nearest}) > std::fabs(value);
  return std::bit_cast<float>(isBeyond ? bits - 1 : bits + 1);
}

std::uint32_t quantize(Scalar narrow, const Literal& literal) {
  if (narrow != Scalar::Half) return quantize(narrow, literal.bits);
  return quantize(narrow, std::bit_cast<std::uint32_t>(roundedToOdd(wideValue(literal))));
}

std::uint32_t quantize(Scalar narrow, std::uint32_t bits) {
  const auto value = std::bit_cast<float>(bits);
  switch (narrow) {
    case Scalar::Char: return static_cast<std::uint32_t>(std::int32_t{static_cast<std::int8_t>(bits)});
    case Scalar::Short: return static_cast<std::uint32_t>(std::int32_t{static_cast<std::int16_t>(bits)});
    case Scalar::Uchar: return bits & 0xffU;
    case Scalar::Ushort: return bits & 0xffffU;
    case Scalar::Half: return std::bit_cast<std::uint32_t>(nearestHalf(value));
    case Scalar::Unorm8:
    case Scalar::Unorm16:
      return std::bit_cast<std::uint32_t>(nearestNormalized(value, 0, normalizedScale(narrow)));
    case Scalar::Snorm8:
    case Scalar::Snorm16:
      return std::bit_cast<std::uint32_t>(nearestNormalized(value, -1, normalizedScale(narrow)));
    case Scalar::Bool:
    case Scalar::Int:
    case Scalar::Uint:
    case Scalar::Float:
    case Scalar::Double: break;
  }
  assert(!"not a narrow scalar");
  return bits;
}

}  // namespace skc::ir
