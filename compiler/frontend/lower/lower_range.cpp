// SPDX-License-Identifier: MIT
//
// Lowers [[range(lo, hi)]]: evaluates the ends as real numbers, and checks that the parameter's type has such values. The ends
// keep the precision of their text, so that 0.1 is the same end for floats and for doubles.
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include <clang/AST/Decl.h>
#include <clang/AST/Expr.h>

#include "frontend/lower/module_lowering.hpp"
#include "ir/build.hpp"
#include "ir/ir.hpp"
#include "ir/scalar_operations.hpp"

namespace skc::frontend {

using clang::SourceLocation;

namespace {

bool isOfReals(ir::Scalar scalar) {
  const ir::Scalar arithmetic = ir::arithmeticScalar(scalar);
  return arithmetic == ir::Scalar::Float || arithmetic == ir::Scalar::Double;
}

/// The value of a scalar constant; floats are not rounded. Nullopt for what is no operator of numbers.
std::optional<double> unroundedValue(const ir::Module& module, const ir::Expr& e) {
  if (!e.type.isScalar()) return std::nullopt;
  const auto valueOf = [&](const ir::ExprPtr& part) { return unroundedValue(module, *part); };
  if (const auto* n = std::get_if<ir::Literal>(&e.node)) {
    const bool isFloat = ir::arithmeticScalar(e.type.scalar) == ir::Scalar::Float;
    return isFloat ? ir::wideValue(*n) : ir::valueOf(e.type.scalar, *n);
  }
  if (const auto* n = std::get_if<ir::ConstantRef>(&e.node))
    return valueOf(module.constants[n->constant].value);
  if (const auto* n = std::get_if<ir::Unary>(&e.node)) {
    const std::optional<double> x = valueOf(n->operand);
    return x ? std::optional(ir::computed(n->op, e.type.scalar, *x)) : std::nullopt;
  }
  if (const auto* n = std::get_if<ir::Binary>(&e.node)) {
    const std::optional<double> x = valueOf(n->lhs), y = valueOf(n->rhs);
    return x && y ? ir::computed(n->op, n->lhs->type.scalar, *x, *y) : std::nullopt;
  }
  if (const auto* n = std::get_if<ir::Convert>(&e.node)) {
    const std::optional<double> x = valueOf(n->operand);
    return x ? std::optional(ir::converted(n->operand->type.scalar, e.type.scalar, *x)) : std::nullopt;
  }
  if (const auto* n = std::get_if<ir::IntrinsicCall>(&e.node)) {
    double x[3] = {};
    if (n->args.size() > 3) return std::nullopt;
    for (std::size_t i = 0; i < n->args.size(); ++i) {
      const std::optional<double> argument = valueOf(n->args[i]);
      if (!argument) return std::nullopt;
      x[i] = *argument;
    }
    return ir::computed(n->intrinsic, e.type.scalar, x[0], x[1], x[2]);
  }
  if (const auto* n = std::get_if<ir::Select>(&e.node)) {
    const std::optional<double> cond = valueOf(n->cond);
    return cond ? valueOf(*cond != 0 ? n->yes : n->no) : std::nullopt;
  }
  return std::nullopt;
}

/// The least and the greatest integer that ranges of the type may end at. A double represents all of them.
ir::ValueRange integersOf(ir::Scalar scalar) {
  constexpr double most = 0x1p53;
  switch (scalar) {
    case ir::Scalar::Char: return {-128, 127};
    case ir::Scalar::Uchar: return {0, 255};
    case ir::Scalar::Short: return {-32768, 32767};
    case ir::Scalar::Ushort: return {0, 65535};
    case ir::Scalar::Int: return {-0x1p31, 0x1p31 - 1};
    case ir::Scalar::Uint: return {0, 0x1p32 - 1};
    case ir::Scalar::Ulong: return {0, most};
    default: return {-most, most};
  }
}

}  // namespace

/// The scalar of a parameter's numbers; reports a type that has others, or none.
ir::Scalar ModuleLowering::scalarInRange(const ir::KernelParam& param, SourceLocation where) {
  ir::Type type = param.type;
  if (type.kind == ir::Type::Kind::Array) type = module_.arrays[type.index].element;
  if (type.kind == ir::Type::Kind::Struct || type.isBool() || type.scalar == ir::Scalar::Bool)
    fail(Diag::RangeType, where, {param.name, spelling(param.type)});
  return type.scalar;
}

/// One end of a range, which the constant of this name holds.
double ModuleLowering::rangeEnd(const std::string& constant, const ir::KernelParam& param,
                                ir::Scalar scalar) {
  const clang::VarDecl* variable = generatedVariable(constant);
  const SourceLocation where = variable->getAnyInitializer()->getBeginLoc();
  const ir::ExprPtr value = constantValue(variable, /*inlined=*/true);
  if (!value->type.isScalar() || value->type.isBool())
    fail(Diag::RangeNumber, where, {param.name, spelling(value->type)});
  const std::optional<double> end = unroundedValue(module_, *value);
  if (!end) fail(Diag::NotConstant, where);
  if (std::isnan(*end)) fail(Diag::RangeNumber, where, {param.name, "NaN"});
  if (isOfReals(scalar) || std::isinf(*end)) return *end;
  const ir::ValueRange integers = integersOf(scalar);
  if (*end != std::trunc(*end) || *end < integers.low || *end > integers.high) {
    fail(Diag::RangeInteger, where,
         {param.name, fmt::format("{}", *end), spelling(ir::Type::of(scalar)),
          fmt::format("{:.0f}", integers.low), fmt::format("{:.0f}", integers.high)});
  }
  return *end;
}

ir::ValueRange ModuleLowering::range(const RangeSyntax& syntax, const ir::KernelParam& param,
                                     SourceLocation where) {
  const ir::Scalar scalar = scalarInRange(param, where);
  const ir::ValueRange range{rangeEnd(syntax.low, param, scalar), rangeEnd(syntax.high, param, scalar)};
  if (range.low > range.high) {
    fail(Diag::RangeOrder, generatedVariable(syntax.low)->getAnyInitializer()->getBeginLoc(),
         {param.name, fmt::format("{}", range.low), fmt::format("{}", range.high)});
  }
  return range;
}

}  // namespace skc::frontend
