// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include "transforms/hoist_expressions.hpp"

namespace skc {

using namespace ir;

namespace {

/// Whether values of the type are structs or arrays in GLSL.
bool isAggregate(Type type) {
  return type.kind == Type::Kind::Struct || type.kind == Type::Kind::Array || type.is64Bit();
}

bool isForbidden(const Expr& expr) {
  const auto* n = std::get_if<Select>(&expr.node);
  return n != nullptr && n->cond->type.isScalar() && isAggregate(expr.type);
}

}  // namespace

void expandSelects(Module& module) {
  for (Function& function : module.functions)
    hoistExpressions(function, [](const Expr& expr) { return isForbidden(expr); });
}

}  // namespace skc
