// SPDX-License-Identifier: MIT
#include "transforms/fold_identity.hpp"

#include <algorithm>
#include <limits>

#include "ir/build.hpp"

namespace skc {

using namespace ir;

namespace {

/// Converts a literal of the arithmetic type to a narrow type.
ExprPtr narrowed(Scalar scalar, ExprPtr value) {
  value->type = Type::of(scalar);
  return value;
}

/// The smallest or largest value of a component type.
ExprPtr extreme(Scalar scalar, bool largest) {
  using Int = std::numeric_limits<std::int32_t>;
  const float infinity = std::numeric_limits<float>::infinity();
  const auto integer = [&](std::int32_t low, std::int32_t high) {
    return narrowed(scalar, literal(largest ? high : low));
  };
  const auto real = [&](float low, float high) { return narrowed(scalar, literal(largest ? high : low)); };
  switch (scalar) {
    case Scalar::Bool: return literal(largest);
    case Scalar::Int: return literal(largest ? Int::max() : Int::min());
    case Scalar::Uint: return literal(largest ? 0xffffffffU : 0U);
    case Scalar::Char: return integer(-128, 127);
    case Scalar::Uchar: return integer(0, 255);
    case Scalar::Short: return integer(-32768, 32767);
    case Scalar::Ushort: return integer(0, 65535);
    case Scalar::Unorm8:
    case Scalar::Unorm16: return real(0, 1);
    case Scalar::Snorm8:
    case Scalar::Snorm16: return real(-1, 1);
    case Scalar::Double: return literal(largest ? double{infinity} : -double{infinity});
    case Scalar::Float:
    case Scalar::Half: break;
  }
  return real(-infinity, infinity);
}

/// An integer with all bits set.
ExprPtr allBits(Scalar scalar) {
  const bool isUnsigned = scalar == Scalar::Uchar || scalar == Scalar::Ushort;
  return isUnsigned ? extreme(scalar, true) : literalOf(Type::of(scalar), -1);
}

}  // namespace

ExprPtr neutralOf(FoldOp op, Scalar scalar) {
  if (const auto* intrinsic = std::get_if<Intrinsic>(&op))
    return extreme(scalar, *intrinsic == Intrinsic::Min);
  const Type type = Type::of(scalar);
  const BinaryOp binary = std::get<BinaryOp>(op);
  if (binary == BinaryOp::BitAnd) return allBits(scalar);
  if (binary == BinaryOp::Mul || binary == BinaryOp::LogicalAnd) return literalOf(type, 1);
  return literalOf(type, 0);
}

bool isIdempotent(FoldOp op) {
  if (std::holds_alternative<Intrinsic>(op)) return true;
  const BinaryOp binary = std::get<BinaryOp>(op);
  return binary == BinaryOp::BitAnd || binary == BinaryOp::BitOr || binary == BinaryOp::LogicalAnd ||
         binary == BinaryOp::LogicalOr;
}

bool hasIdentities(const Kernel& kernel) {
  return std::ranges::none_of(kernel.params, [](const KernelParam& param) {
    return param.role == ParamRole::Accumulator && param.identity == nullptr;
  });
}

}  // namespace skc
