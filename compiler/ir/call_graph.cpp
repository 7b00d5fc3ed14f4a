// SPDX-License-Identifier: MIT
#include "ir/call_graph.hpp"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::ir {
namespace {

enum class Mark : std::uint8_t { New, Open, Done };
/// A kernel calls few of a module's functions, so that a mark for each of these would cost more than the visit.
using Marks = std::unordered_map<FunctionId, Mark>;

/// Visits the call graph depth first; returns false if it finds a cycle.
bool visit(const Module& module, FunctionId id, Marks& marks, std::vector<FunctionId>& order) {
  if (id >= module.functions.size() || marks[id] == Mark::Done) return true;
  if (marks[id] == Mark::Open) return false;
  marks[id] = Mark::Open;
  for (FunctionId callee : callees(module.functions[id])) {
    if (!visit(module, callee, marks, order)) return false;
  }
  marks[id] = Mark::Done;
  order.push_back(id);
  return true;
}

}  // namespace

std::vector<FunctionId> callees(const Function& function) {
  std::vector<FunctionId> found;
  std::unordered_set<FunctionId> known;
  const auto add = [&](FunctionId id) {
    if (known.insert(id).second) found.push_back(id);
  };
  walkStmts(function.body, [&](const Stmt& stmt) {
    if (const auto* n = std::get_if<CallStmt>(&stmt.node)) add(n->callee);
  });
  walkExprs(function.body, [&](const Expr& expr) {
    if (const auto* n = std::get_if<Call>(&expr.node)) add(n->callee);
  });
  return found;
}

std::vector<FunctionId> functionsOf(const Module& module, const Kernel& kernel) {
  Marks marks;
  std::vector<FunctionId> order;
  visit(module, kernel.entry, marks, order);
  return order;
}

std::optional<Loc> usesIndex(const Module& module, const Kernel& kernel) {
  std::optional<Loc> found;
  for (const KernelParam& param : kernel.params) {
    if (param.role == ParamRole::Iterator) found = param.loc;
  }
  for (FunctionId id : functionsOf(module, kernel)) {
    walkExprs(module.functions[id].body, [&](const Expr& expr) {
      const auto* extent = std::get_if<ExtentOf>(&expr.node);
      const bool isOfGather = extent != nullptr &&
                              extent->stream.space == StreamRef::Space::KernelParameter &&
                              kernel.params[extent->stream.id].role == ParamRole::Gather;
      const bool readsIndex = std::holds_alternative<IndexOf>(expr.node) ||
                              std::holds_alternative<NeighborRead>(expr.node) ||
                              (extent != nullptr && !isOfGather);
      if (readsIndex && !found) found = expr.loc;
    });
  }
  return found;
}

std::optional<FunctionId> findRecursion(const Module& module) {
  Marks marks;
  std::vector<FunctionId> order;
  for (FunctionId id = 0; id < module.functions.size(); ++id) {
    if (!visit(module, id, marks, order)) return id;
  }
  return std::nullopt;
}

std::vector<FunctionId> tabulatedFunctionsOf(const Module& module, const Kernel& kernel) {
  std::vector<FunctionId> found = functionsOf(module, kernel);
  std::erase_if(found, [&](FunctionId id) { return !module.functions[id].table; });
  return found;
}

bool holdsDouble(const Module& module, Type type) { return holds(module, type, Scalar::Double); }

namespace {

/// True if a value in the kernel has a type for which `isOne` is true.
template <class IsOne>
bool usesType(const Module& module, const Kernel& kernel, IsOne isOne) {
  for (const FunctionId id : functionsOf(module, kernel)) {
    const Function& function = module.functions[id];
    bool uses = isOne(function.result);
    for (const Variable& variable : function.variables) uses = uses || isOne(variable.type);
    walkExprs(function.body, [&](const Expr& expr) { uses = uses || isOne(expr.type); });
    if (uses) return true;
  }
  return false;
}

}  // namespace

bool usesDoubles(const Module& module, const Kernel& kernel) {
  return usesType(module, kernel, [&](Type type) { return holdsDouble(module, type); });
}

bool usesLongs(const Module& module, const Kernel& kernel) {
  return usesType(module, kernel, [&](Type type) {
    return holds(module, type, Scalar::Long) || holds(module, type, Scalar::Ulong);
  });
}

bool usesExactSums(const Module& module, const Kernel& kernel) {
  constexpr Intrinsic exact[] = {Intrinsic::RoundedSum, Intrinsic::SumError, Intrinsic::RoundedProduct,
                                 Intrinsic::ProductError};
  for (const FunctionId id : functionsOf(module, kernel)) {
    bool uses = false;
    walkExprs(module.functions[id].body, [&](const Expr& expr) {
      const auto* n = std::get_if<IntrinsicCall>(&expr.node);
      uses = uses || (n != nullptr && std::ranges::find(exact, n->intrinsic) != std::end(exact));
    });
    if (uses) return true;
  }
  return false;
}

}  // namespace skc::ir
