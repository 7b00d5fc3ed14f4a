// SPDX-License-Identifier: MIT
#include "transforms/hoist_calls.hpp"

#include <algorithm>
#include <vector>

#include "ir/counted_loop.hpp"
#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "transforms/hoist_expressions.hpp"

namespace skc {

using namespace ir;

namespace {

bool hasOpenLoop(const Module& module, const Function& function) {
  bool found = false;
  walkStmts(function.body, [&](const Stmt& stmt) {
    const auto* loop = std::get_if<Loop>(&stmt.node);
    found = found || (loop != nullptr && !isCounted(module, *loop));
  });
  return found;
}

}  // namespace

std::set<FunctionId> longFunctions(const Module& module) {
  std::set<FunctionId> found;
  for (const Kernel& kernel : module.kernels) {
    for (const FunctionId id : functionsOf(module, kernel)) {  // callees first
      const Function& function = module.functions[id];
      const std::vector<FunctionId> called = callees(function);
      const bool callsLong =
          std::ranges::any_of(called, [&](FunctionId callee) { return found.contains(callee); });
      if (callsLong || hasOpenLoop(module, function)) found.insert(id);
    }
  }
  return found;
}

bool callsOneOf(const std::set<FunctionId>& functions, const Expr& expr) {
  bool found = false;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<Call>(&inner.node);
    found = found || (n != nullptr && functions.contains(n->callee));
  });
  return found;
}

void hoistCalls(Function& function, const std::set<FunctionId>& functions) {
  hoistExpressions(function, [&](const Expr& expr) {
    const auto* n = std::get_if<Call>(&expr.node);
    return n != nullptr && functions.contains(n->callee);
  });
}

}  // namespace skc
