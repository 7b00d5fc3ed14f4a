// SPDX-License-Identifier: MIT
#include "transforms/copy_functions.hpp"

#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc {

using namespace ir;

FunctionId copyFunction(Module& module, FunctionId id, FunctionCopies& copies) {
  if (const auto known = copies.find(id); known != copies.end()) return known->second;
  Function copy = clone(module.functions[id]);
  walkStmts(copy.body, [&](Stmt& stmt) {
    if (auto* n = std::get_if<CallStmt>(&stmt.node)) n->callee = copyFunction(module, n->callee, copies);
  });
  walkExprs(copy.body, [&](Expr& expr) {
    if (auto* n = std::get_if<Call>(&expr.node)) n->callee = copyFunction(module, n->callee, copies);
  });
  module.functions.push_back(std::move(copy));
  return copies[id] = static_cast<FunctionId>(module.functions.size() - 1);
}

void dropTables(Module& module, const FunctionCopies& copies) {
  for (const auto& [from, to] : copies) module.functions[to].table.reset();
}

}  // namespace skc
