// SPDX-License-Identifier: MIT
#include "frontend/lower/convert_literal.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include <llvm/ADT/APSInt.h>

#include "ir/build.hpp"
#include "ir/scalar_operations.hpp"

namespace skc::frontend {
namespace {

using ir::ExprPtr;
using ir::Literal;
using ir::Scalar;

/// Truncates and saturates, and NaN becomes 0, as everywhere (ir/scalar_operations.hpp).
std::uint64_t truncated(double value, bool isSigned) {
  value = std::trunc(value);
  if (std::isnan(value)) return 0;
  if (!isSigned)
    return value <= 0 ? 0 : value < 0x1p64 ? static_cast<std::uint64_t>(value) : ~std::uint64_t{0};
  if (std::fabs(value) < 0x1p63) return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
  return value < 0 ? std::uint64_t{1} << 63U : ~std::uint64_t{0} >> 1U;
}

/// The bits of an integer of 64 bits that a literal of another type becomes.
std::uint64_t longBits(Scalar from, const Literal& literal, bool isSigned) {
  if (from == Scalar::Int)
    return static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(literal.bits)});
  if (from == Scalar::Float) return truncated(ir::wideValue(literal), isSigned);  // 1e18 is no float
  return from == Scalar::Double ? truncated(ir::valueOf(from, literal), isSigned) : literal.wide();
}

/// A literal whose value is this integer.
template <class Integer>
ExprPtr ofInteger(Integer number, Scalar to, Loc loc) {
  switch (to) {
    case Scalar::Int: return ir::literal(static_cast<std::int32_t>(number), loc);
    case Scalar::Uint: return ir::literal(static_cast<std::uint32_t>(number), loc);
    case Scalar::Long: return ir::literal(static_cast<std::int64_t>(number), loc);
    case Scalar::Ulong: return ir::literal(static_cast<std::uint64_t>(number), loc);
    case Scalar::Double: return ir::literal(static_cast<double>(number), loc);
    case Scalar::Float: return ir::literal(static_cast<float>(number), static_cast<double>(number), loc);
    default: return nullptr;
  }
}

/// To an arithmetic type other than `from`.
ExprPtr ofArithmetic(Scalar from, const Literal& literal, Scalar to, Loc loc) {
  if (to == Scalar::Long || to == Scalar::Ulong) {
    const Literal wide = Literal::wide(longBits(from, literal, to == Scalar::Long));
    return ir::makeExpr(ir::Type::of(to), wide, loc);
  }
  switch (from) {
    case Scalar::Int: return ofInteger(static_cast<std::int32_t>(literal.bits), to, loc);
    case Scalar::Uint: return to == Scalar::Int ? nullptr : ofInteger(literal.bits, to, loc);
    case Scalar::Long: return ofInteger(static_cast<std::int64_t>(literal.wide()), to, loc);
    case Scalar::Ulong: return ofInteger(literal.wide(), to, loc);
    case Scalar::Float:
      return to == Scalar::Double ? ir::literal(double{std::bit_cast<float>(literal.bits)}, loc) : nullptr;
    case Scalar::Bool:
      return to == Scalar::Double ? ir::literal(literal.bits != 0 ? 1.0 : 0.0, loc) : nullptr;
    default: return nullptr;
  }
}

}  // namespace

std::uint64_t lowBits(const llvm::APSInt& number) { return number.extOrTrunc(64).getZExtValue(); }

ExprPtr convertLiteral(const ir::Expr& e, Scalar to) {
  const auto& literal = std::get<Literal>(e.node);
  const Scalar from = ir::arithmeticScalar(e.type.scalar);  // a literal of a storage type has its bits
  const Scalar arithmetic = ir::arithmeticScalar(to);
  if (from == Scalar::Double && to == Scalar::Half) {
    const float odd = ir::roundedToOdd(ir::valueOf(from, literal));
    return ir::makeExpr(ir::Type::of(to), Literal{ir::quantize(to, std::bit_cast<std::uint32_t>(odd))},
                        e.loc);
  }
  ExprPtr result = from == arithmetic ? ir::makeExpr(ir::Type::of(from), literal, e.loc)
                                      : ofArithmetic(from, literal, arithmetic, e.loc);
  if (!result || arithmetic == to) return result;
  const std::uint32_t bits = ir::quantize(to, std::get<Literal>(result->node));
  return ir::makeExpr(ir::Type::of(to), Literal{bits}, e.loc);
}

}  // namespace skc::frontend
