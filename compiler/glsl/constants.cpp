// SPDX-License-Identifier: MIT
#include "glsl/constants.hpp"

#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "ir/walk.hpp"
#include "support/text.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// True if the node itself prints as a function call.
bool isCall(const Expr& expr, const std::vector<bool>& isFunction) {
  if (expr.type.is64Bit()) return true;
  if (const auto* n = std::get_if<Literal>(&expr.node))
    return expr.type.arithmeticType().isFloat() && !std::isfinite(std::bit_cast<float>(n->bits));
  if (const auto* n = std::get_if<ConstantRef>(&expr.node)) return isFunction[n->constant];
  if (const auto* n = std::get_if<Binary>(&expr.node)) return n->lhs->type.isVector() && expr.type.isBool();
  if (const auto* n = std::get_if<Unary>(&expr.node))
    return n->op == UnaryOp::LogicalNot && expr.type.isVector();
  if (const auto* n = std::get_if<Select>(&expr.node)) return n->cond->type.isVector();
  return std::holds_alternative<Call>(expr.node) || std::holds_alternative<IntrinsicCall>(expr.node);
}

}  // namespace

std::vector<bool> functionConstants(const Module& module) {
  std::vector<bool> isFunction(module.constants.size(), false);
  for (ConstantId id = 0; id < isFunction.size(); ++id) {   // a constant refers only to earlier ones
    walkExprs(static_cast<const Expr&>(*module.constants[id].value), [&](const Expr& expr) {
      if (isCall(expr, isFunction)) isFunction[id] = true;
    });
  }
  return isFunction;
}

std::string constantText(const GlslContext& context, ConstantId id) {
  const Constant& constant = context.module.constants[id];
  const std::string& name = context.types.constantUse(id);
  const std::string value = glslExpr(context, std::nullopt, *constant.value);
  const bool isFunction = name.back() == ')';
  const std::string text =
      isFunction ? fmt::format("{} {} {{ return {}; }}", context.types.glsl(constant.type), name, value)
                 : fmt::format("const {} = {};", context.types.declaration(constant.type, name), value);
  return wrapLine(text) + "\n";
}

}  // namespace skc::emit
