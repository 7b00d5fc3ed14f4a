// SPDX-License-Identifier: MIT
#include "transforms/fold_samples.hpp"

#include <cstddef>

namespace skc {
namespace {

using namespace ir;

/// A number below `count` that looks random.
int pick(int a, int b, int count) {
  std::uint32_t bits =
      static_cast<std::uint32_t>(a) * 0x9e3779b1U + static_cast<std::uint32_t>(b) * 0x85ebca6bU + 1;
  bits = (bits ^ bits >> 15U) * 0x2c1b3c6dU;
  bits = (bits ^ bits >> 12U) * 0x297a2d39U;
  return static_cast<int>((bits ^ bits >> 15U) % static_cast<std::uint32_t>(count));
}

std::size_t row(const SampleNumber& n, std::size_t rows) {
  const int at = (n.sample * 5 + n.number * 3) % static_cast<int>(rows);
  return static_cast<std::size_t>(at < 0 ? at + static_cast<int>(rows) : at);
}

double integer(const SampleNumber& n) {
  constexpr std::array<int, 11> values = {1, 3, 2, 7, 5, 4, 9, 6, 11, 8, 10};
  const int random = pick(n.sample, n.number, 4);
  switch (n.kind) {
    case SampleKind::Positive:
    case SampleKind::Signed: return values[row(n, values.size())];
    case SampleKind::Few: return 1 + pick(n.sample, n.number, 3);
    case SampleKind::Unit: return random % 2;
    case SampleKind::Ascending: return 1 + 4 * n.within + random;
    case SampleKind::Descending: return 1 + 4 * (n.count - 1 - n.within) + random;
    case SampleKind::Equal: return 1 + pick(n.sample, n.element, 8);
    case SampleKind::Powers: return 1 << random;
    case SampleKind::OneHot:
      if (n.count == 1) return 1 + random;
      return pick(n.sample, n.element, n.count) == n.within ? 1 : 0;
  }
  return 0;
}

double real(const SampleNumber& n) {
  constexpr std::array<double, 11> values = {1, 2.5, 4, 0.75, 3.25, 1.5, 6, 0.5, 2.25, 5.5, 1.75};
  switch (n.kind) {
    case SampleKind::Positive: return values[row(n, values.size())];
    case SampleKind::Unit: return (1 + pick(n.sample, n.number, 16)) / 16.0;
    case SampleKind::Signed:
    case SampleKind::Few:
    case SampleKind::OneHot: return integer(n);
    case SampleKind::Ascending:
    case SampleKind::Descending:
    case SampleKind::Equal: return integer(n) / 4;
    case SampleKind::Powers: return integer(n) / 2;
  }
  return 0;
}

bool isNormalized(Scalar scalar) {
  return scalar == Scalar::Unorm8 || scalar == Scalar::Unorm16 || scalar == Scalar::Snorm8 ||
         scalar == Scalar::Snorm16;
}

bool isUnsigned(Scalar scalar) {
  return scalar == Scalar::Uint || scalar == Scalar::Uchar || scalar == Scalar::Ushort ||
         scalar == Scalar::Unorm8 || scalar == Scalar::Unorm16;
}

}  // namespace

double sampleOf(Scalar scalar, const SampleNumber& n) {
  if (scalar == Scalar::Bool) {
    const bool isFirst = n.kind == SampleKind::Positive || n.kind == SampleKind::Signed;
    return isFirst ? (n.sample + n.number * 2) / 2 & 1 : pick(n.sample, n.number, 2);
  }
  const bool isReal = ir::isReal(arithmeticScalar(scalar));
  double value = isReal ? real(n) : integer(n);
  if (isNormalized(scalar) && n.kind != SampleKind::Unit && n.kind != SampleKind::OneHot) value /= 16;
  const bool isNegative =
      n.kind == SampleKind::Signed && !isUnsigned(scalar) && (n.sample + n.number) % 2 == 0;
  return isNegative ? -value : value;
}

}  // namespace skc
