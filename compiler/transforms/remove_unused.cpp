// SPDX-License-Identifier: MIT
#include "transforms/remove_unused.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "ir/walk_module.hpp"

namespace skc {
namespace {

using namespace ir;

// ---- locals -----------------------------------------------------------------------------------

/// Marks variables that evaluating an lvalue reads: those in indices, not the root.
void markLValue(const Expr& lvalue, std::vector<bool>& read);

void markRead(const Expr& expr, std::vector<bool>& read) {
  walkExprs(expr, [&](const Expr& inner) {
    if (const auto* n = std::get_if<VarRef>(&inner.node)) read[n->var] = true;
  });
}

void markLValue(const Expr& lvalue, std::vector<bool>& read) {
  if (const auto* n = std::get_if<Index>(&lvalue.node)) {
    markRead(*n->index, read);
    markLValue(*n->base, read);
  } else if (const auto* m = std::get_if<Member>(&lvalue.node)) {
    markLValue(*m->base, read);
  } else if (const auto* s = std::get_if<Swizzle>(&lvalue.node)) {
    markLValue(*s->base, read);
  }
}

/// Which variables are read. An argument of a call counts, since the call may read it; so does a variable
/// that receives a call's result, since the call stays.
std::vector<bool> readVariables(const Function& function) {
  std::vector<bool> read(function.variables.size(), false);
  walkStmts(function.body, [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) {
      markLValue(*n->place, read);
      markRead(*n->value, read);
      return;
    }
    forEachOperand(stmt, [&](const ExprPtr& operand) { markRead(*operand, read); });
  });
  return read;
}

bool removeWrites(Block& block, const std::vector<bool>& dead) {
  const auto writesDead = [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<Declare>(&stmt.node)) return static_cast<bool>(dead[n->var]);
    if (const auto* n = std::get_if<Assign>(&stmt.node)) return static_cast<bool>(dead[rootOf(*n->place)]);
    return false;
  };
  bool changed = std::erase_if(block, writesDead) > 0;
  for (Stmt& stmt : block) {
    forEachBlock(stmt, [&](Block& inner) { changed = removeWrites(inner, dead) || changed; });
  }
  return changed;
}

void removeDeadLocals(Function& function) {
  bool changed = true;
  while (changed) {   // the variables that a dead local was computed from may be dead now
    std::vector<bool> dead = readVariables(function);
    dead.flip();
    for (std::size_t i = 0; i < dead.size(); ++i) {
      dead[i] = dead[i] && function.variables[i].role == VarRole::Local;
    }
    changed = removeWrites(function.body, dead);
  }
}

// ---- tables -----------------------------------------------------------------------------------

/// Maps the old index of each entry that stays to its new one.
std::vector<std::uint32_t> renumber(const std::vector<bool>& used) {
  std::vector<std::uint32_t> numbers;
  std::uint32_t next = 0;
  for (bool isUsed : used) numbers.push_back(isUsed ? next++ : next);
  return numbers;
}

template <class T>
void keep(std::vector<T>& table, const std::vector<bool>& used) {
  std::vector<T> kept;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (used[i]) kept.push_back(std::move(table[i]));
  }
  table = std::move(kept);
}

void removeFunctions(Module& module) {
  std::vector<bool> used(module.functions.size(), false);
  for (const Kernel& kernel : module.kernels) {
    for (FunctionId id : functionsOf(module, kernel)) used[id] = true;
  }
  const std::vector<std::uint32_t> numbers = renumber(used);
  keep(module.functions, used);
  walkExprs(module, [&](Expr& expr) {
    if (auto* n = std::get_if<Call>(&expr.node)) n->callee = numbers[n->callee];
  });
  for (Function& function : module.functions) {
    walkStmts(function.body, [&](Stmt& stmt) {
      if (auto* n = std::get_if<CallStmt>(&stmt.node)) n->callee = numbers[n->callee];
    });
  }
  for (Kernel& kernel : module.kernels) {
    kernel.entry = numbers[kernel.entry];
  }
}

void removeConstants(Module& module) {
  std::vector<bool> used(module.constants.size(), false);
  const auto mark = [&](Expr& expr) {
    if (const auto* n = std::get_if<ConstantRef>(&expr.node)) used[n->constant] = true;
  };
  std::vector<Constant> constants =
      std::exchange(module.constants, {});  // their values count only if they are used
  walkExprs(module, mark);
  module.constants = std::move(constants);
  for (std::size_t i = used.size(); i-- > 0;) {   // a constant refers only to earlier ones
    if (used[i]) walkExprs(*module.constants[i].value, mark);
  }
  const std::vector<std::uint32_t> numbers = renumber(used);
  keep(module.constants, used);
  walkExprs(module, [&](Expr& expr) {
    if (auto* n = std::get_if<ConstantRef>(&expr.node)) n->constant = numbers[n->constant];
  });
}

void removeTypes(Module& module) {
  std::vector<bool> structs(module.structs.size(), false);
  std::vector<bool> arrays(module.arrays.size(), false);
  const auto mark = [&](auto& self, Type type) -> void {
    if (type.kind == Type::Kind::Struct && !structs[type.index]) {
      structs[type.index] = true;
      for (const StructField& field : module.structs[type.index].fields) self(self, field.type);
    }
    if (type.kind == Type::Kind::Array && !arrays[type.index]) {
      arrays[type.index] = true;
      self(self, module.arrays[type.index].element);
    }
  };
  walkTypes(module, [&](Type& type) { mark(mark, type); });
  const std::vector<std::uint32_t> structNumbers = renumber(structs);
  const std::vector<std::uint32_t> arrayNumbers = renumber(arrays);
  const auto apply = [&](Type& type) {
    if (type.kind == Type::Kind::Struct) type.index = structNumbers[type.index];
    if (type.kind == Type::Kind::Array) type.index = arrayNumbers[type.index];
  };
  keep(module.structs, structs);
  keep(module.arrays, arrays);
  walkTypesInTypes(module, apply);
  walkTypes(module, apply);
}

}  // namespace

void removeUnused(Module& module, Diagnostics&) {
  for (Function& function : module.functions) removeDeadLocals(function);   // first: they use the rest
  removeFunctions(module);
  removeConstants(module);
  removeTypes(module);
}

}  // namespace skc
