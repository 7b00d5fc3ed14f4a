// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

/// The base of an lvalue that is part of another; null for a variable.
ExprPtr* baseOf(Expr& place) {
  if (auto* n = std::get_if<Swizzle>(&place.node)) return &n->base;
  if (auto* n = std::get_if<Member>(&place.node)) return &n->base;
  if (auto* n = std::get_if<Index>(&place.node)) return &n->base;
  return nullptr;
}

bool isKnown(const Index& n) { return std::holds_alternative<Literal>(n.index->node); }

/// True for an element of an array at a computed index, and for parts of one.
bool isInComputedElement(Expr& place) {
  const auto* n = std::get_if<Index>(&place.node);
  if (n != nullptr && n->base->type.kind == Type::Kind::Array && !isKnown(*n)) return true;
  ExprPtr* base = baseOf(place);
  return base != nullptr && isInComputedElement(**base);
}

bool isComputedRow(const Expr& place) {
  const auto* n = std::get_if<Index>(&place.node);
  return n != nullptr && n->base->type.isMatrix() && (!isKnown(*n) || isInComputedElement(*n->base));
}

/// The slot of the row at a computed place that contains the lvalue; null if there is none.
ExprPtr* rowOf(Expr& place) {
  ExprPtr* base = baseOf(place);
  if (base == nullptr) return nullptr;
  return isComputedRow(**base) ? base : rowOf(**base);
}

/// Rewrites one function.
class RowWriter {
 public:
  RowWriter(const Module& module, Function& function) : module_(module), function_(function) {}

  void rewrite(Block& block) {
    Block rewritten;
    for (Stmt& stmt : block) {
      forEachBlock(stmt, [&](Block& inner) { rewrite(inner); });
      Block after;
      if (auto* n = std::get_if<Assign>(&stmt.node)) through(*n->place, stmt.loc, rewritten, after);
      if (auto* n = std::get_if<CallStmt>(&stmt.node)) {
        for (std::size_t i = 0; i < n->args.size(); ++i) {
          const bool isLValue = module_.functions[n->callee].variables[i].role == VarRole::InOut;
          if (isLValue) through(*n->args[i], stmt.loc, rewritten, after);
        }
        if (n->result) through(*n->result, stmt.loc, rewritten, after);
      }
      rewritten.push_back(std::move(stmt));
      for (Stmt& write : after) rewritten.push_back(std::move(write));
    }
    block = std::move(rewritten);
  }

 private:
  /// Replaces the row that contains `place` by a variable. Saves the index, too, because the statement may
  /// change variables that it depends on.
  void through(Expr& place, Loc loc, Block& before, Block& after) {
    ExprPtr* row = rowOf(place);
    if (row == nullptr) return;
    Index& n = std::get<Index>((*row)->node);
    const std::string matrix = function_.variables[rootOf(**row)].name;
    if (!isKnown(n)) {
      const VarId number = addVariable(function_, matrix + "_index", n.index->type);
      before.push_back(declare(number, std::move(n.index), loc));
      n.index = varRef(function_, number, loc);
    }
    const VarId copy = addVariable(function_, matrix + "_row", (*row)->type);
    before.push_back(declare(copy, clone(*row), loc));
    after.push_back(assign(std::move(*row), varRef(function_, copy, loc), loc));
    *row = varRef(function_, copy, loc);
  }

  const Module& module_;
  Function& function_;
};

}  // namespace

void assignRows(Module& module, Diagnostics&) {
  for (Function& function : module.functions) RowWriter(module, function).rewrite(function.body);
}

}  // namespace skc
