// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

/// What a part belongs to, or null if the expression is no part.
const ExprPtr* wholeOf(const Expr& expr) {
  if (const auto* n = std::get_if<Member>(&expr.node)) return &n->base;
  if (const auto* n = std::get_if<Index>(&expr.node)) return &n->base;
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) return &n->base;
  return nullptr;
}

/// True if GLSL names the value without a function, so that there is nothing to expand.
bool isNamed(const Expr& expr) {
  if (std::holds_alternative<VarRef>(expr.node)) return true;
  if (std::holds_alternative<Literal>(expr.node)) return !expr.type.is64Bit();
  const auto* index = std::get_if<Index>(&expr.node);
  if (index != nullptr && !std::holds_alternative<Literal>(index->index->node)) return false;
  const ExprPtr* whole = wholeOf(expr);
  return whole != nullptr && !expr.type.is64Bit() && isNamed(**whole);
}

bool isPartOfPart(const Expr& place) {
  const ExprPtr* whole = wholeOf(place);
  return whole != nullptr && wholeOf(**whole) != nullptr;
}

class Copier {
 public:
  Copier(const Module& module, Function& function) : module_(module), function_(function) {}

  void block(Block& statements) {
    for (Stmt& stmt : statements) {
      forEachBlock(stmt, [&](Block& inner) { block(inner); });
      if (std::holds_alternative<CallStmt>(stmt.node)) call(stmt);
    }
  }

 private:
  bool isWritten(const CallStmt& n, VarId parameter) const {
    return module_.functions[n.callee].variables[parameter].role == VarRole::InOut;
  }

  void call(Stmt& stmt) {
    auto& n = std::get<CallStmt>(stmt.node);
    const Loc loc = stmt.loc;
    const bool expands = !std::ranges::all_of(n.args, [](const ExprPtr& arg) { return isNamed(*arg); });
    Block before, after;
    for (VarId i = 0; expands && i < n.args.size(); ++i) {
      if (!isWritten(n, i) || !isPartOfPart(*n.args[i])) continue;
      const VarId part = addVariable(function_, "part", n.args[i]->type, VarRole::Local, loc);
      before.push_back(declare(part, clone(n.args[i]), loc));
      after.push_back(
          assign(std::exchange(n.args[i], varRef(function_, part, loc)), varRef(function_, part, loc), loc));
    }
    if (after.empty()) return;
    before.push_back(std::move(stmt));
    std::ranges::move(after, std::back_inserter(before));
    stmt = scope(std::move(before), loc);
  }

  const Module& module_;
  Function& function_;
};

}  // namespace

void copyParts(Module& module, Diagnostics&) {
  for (Function& function : module.functions) Copier(module, function).block(function.body);
}

}  // namespace skc
