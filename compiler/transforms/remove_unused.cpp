// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

// ---- locals -----------------------------------------------------------------------------------

void addRead(const Expr& expr, std::vector<VarId>& read) {
  walkExprs(expr, [&](const Expr& inner) {
    if (const auto* n = std::get_if<VarRef>(&inner.node)) read.push_back(n->var);
  });
}

/// Adds the variables that evaluating an lvalue reads: those in indices, not the root.
void addReadByLValue(const Expr& lvalue, std::vector<VarId>& read) {
  if (const auto* n = std::get_if<Index>(&lvalue.node)) {
    addRead(*n->index, read);
    addReadByLValue(*n->base, read);
  } else if (const auto* m = std::get_if<Member>(&lvalue.node)) {
    addReadByLValue(*m->base, read);
  } else if (const auto* s = std::get_if<Swizzle>(&lvalue.node)) {
    addReadByLValue(*s->base, read);
  }
}

/// The variables that a statement reads, apart from its blocks. An argument of a call counts, since the call may read it; so
/// does a variable that receives a call's result, since the call stays.
std::vector<VarId> readBy(const Stmt& stmt) {
  std::vector<VarId> read;
  if (const auto* n = std::get_if<Assign>(&stmt.node)) {
    addReadByLValue(*n->place, read);
    addRead(*n->value, read);
  } else {
    forEachOperand(stmt, [&](const ExprPtr& operand) { addRead(*operand, read); });
  }
  return read;
}

/// The variable that a statement declares or assigns to, if that is all it does.
std::optional<VarId> written(const Stmt& stmt) {
  if (const auto* n = std::get_if<Declare>(&stmt.node)) return n->var;
  if (const auto* n = std::get_if<Assign>(&stmt.node)) return rootOf(*n->place);
  return std::nullopt;
}

void removeWrites(Block& block, const std::vector<bool>& dead) {
  std::erase_if(block, [&](const Stmt& stmt) {
    const std::optional<VarId> var = written(stmt);
    return var && dead[*var];
  });
  for (Stmt& stmt : block) forEachBlock(stmt, [&](Block& inner) { removeWrites(inner, dead); });
}

void removeDeadLocals(Function& function) {
  // the statements that read each variable; those that write a variable stop to count when it is found dead
  std::vector<std::size_t> readers(function.variables.size(), 0);
  std::vector<std::vector<VarId>> neededFor(function.variables.size());
  walkStmts(function.body, [&](const Stmt& stmt) {
    const std::optional<VarId> var = written(stmt);
    for (const VarId read : readBy(stmt)) {
      ++readers[read];
      if (var) neededFor[*var].push_back(read);
    }
  });
  std::vector<bool> dead(function.variables.size(), false);
  std::vector<VarId> found;
  const auto look = [&](VarId var) {
    if (readers[var] > 0 || dead[var] || function.variables[var].role != VarRole::Local) return;
    dead[var] = true;
    found.push_back(var);
  };
  for (VarId var = 0; var < function.variables.size(); ++var) look(var);
  while (!found.empty()) {  // the variables that a dead local was computed from may be dead now
    const VarId var = found.back();
    found.pop_back();
    for (const VarId read : std::exchange(neededFor[var], {})) {
      --readers[read];
      look(read);
    }
  }
  removeWrites(function.body, dead);
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
  for (std::size_t i = used.size(); i-- > 0;) {  // a constant refers only to earlier ones
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
  for (Function& function : module.functions) removeDeadLocals(function);  // first: they use the rest
  removeFunctions(module);
  removeConstants(module);
  removeTypes(module);
}

}  // namespace skc
