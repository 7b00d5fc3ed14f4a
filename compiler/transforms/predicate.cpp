// SPDX-License-Identifier: MIT
#include "transforms/predicate.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/uniformity.hpp"
#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/ir.hpp"
#include "ir/lvalue.hpp"
#include "ir/validate.hpp"
#include "ir/walk.hpp"
#include "support/internal_error.hpp"
#include "transforms/hoist_expressions.hpp"
#include "transforms/predicate_function.hpp"

namespace skc {

namespace {

// Private to predicate: gives a counter that is read after its loop a copy that the loop reads. Lanes leave the loop at
// different times, so that the counter varies afterwards. As long as a lane stays in the loop, its counter has the
// same value as that of any other lane there: the copy is uniform.
//
//   int n = 0;                            int n = 0;
//                                         int count = 0;
//   while (n < most && f(x)) {            while (count < most && f(x)) {
//     ++n;                                  ++count;
//                                           ++n;
//   }                                     }

using namespace ir;

/// The scalar variable that a statement changes by a literal.
std::optional<VarId> counterOf(const Stmt& stmt) {
  const auto* const n = std::get_if<Assign>(&stmt.node);
  if (n == nullptr || !n->op || !n->place->type.isScalar()) return std::nullopt;
  const auto* const counter = std::get_if<VarRef>(&n->place->node);
  const bool isSteady = std::holds_alternative<Literal>(n->value->node);
  return counter != nullptr && isSteady ? std::optional(counter->var) : std::nullopt;
}

/// The literal that a variable holds after these statements; null if it may hold anything else.
const Expr* literalAfter(const Module& module, std::span<const Stmt> statements, VarId var) {
  for (std::size_t i = statements.size(); i-- > 0;) {
    const Stmt& stmt = statements[i];
    const auto asLiteral = [](const Expr* value) {
      return value != nullptr && std::holds_alternative<Literal>(value->node) ? value : nullptr;
    };
    if (const auto* const n = std::get_if<Declare>(&stmt.node); n != nullptr && n->var == var)
      return asLiteral(n->init.get());
    if (const auto* const n = std::get_if<Assign>(&stmt.node); n != nullptr && rootOf(*n->place) == var) {
      const bool isWhole = !n->op && std::holds_alternative<VarRef>(n->place->node);
      return isWhole ? asLiteral(n->value.get()) : nullptr;
    }
    bool isChanged = false;
    forEachAssigned(module, stmt, [&](VarId assigned) { isChanged = isChanged || assigned == var; });
    forEachBlock(stmt, [&](const Block& inner) { isChanged = isChanged || assigns(module, inner, var); });
    if (isChanged) return nullptr;
  }
  return nullptr;
}

bool continues(const Block& block) {
  bool found = false;
  walkStmts(block, [&](const Stmt& stmt) { found = found || std::holds_alternative<Continue>(stmt.node); });
  return found;
}

bool isDeclared(const Block& statements, VarId var) {
  return std::ranges::any_of(statements, [&](const Stmt& stmt) {
    const auto* const n = std::get_if<Declare>(&stmt.node);
    return n != nullptr && n->var == var;
  });
}

class CounterSplitter {
 public:
  CounterSplitter(const Module& module, Function& function, FunctionId id,
                  const analysis::Uniformity& uniformity)
      : module_(module), function_(function), id_(id), uniformity_(uniformity) {}

  /// From the last statement to the first: the analysis knows statements by address, and insertions move later ones.
  bool block(Block& statements) {
    bool changed = false;
    for (std::size_t i = statements.size(); i-- > 0;) {
      forEachBlock(statements[i], [&](Block& inner) { changed = block(inner) || changed; });
      auto* const loop = std::get_if<Loop>(&statements[i].node);
      if (loop == nullptr || !uniformity_.diverges(id_, statements[i])) continue;
      Block declared;
      const std::span<const Stmt> before(statements.data(), i);
      split(*loop, loop->step, before, declared);
      if (!continues(loop->body)) split(*loop, loop->body, before, declared);
      changed = changed || !declared.empty();
      statements.insert(statements.begin() + static_cast<std::ptrdiff_t>(i),
                        std::make_move_iterator(declared.begin()), std::make_move_iterator(declared.end()));
    }
    return changed;
  }

 private:
  /// Splits the counters that change in one block of the loop, its body or its step.
  void split(Loop& loop, Block& changing, std::span<const Stmt> before, Block& declared) {
    for (std::size_t i = 0; i < changing.size(); ++i) {
      const std::optional<VarId> counter = counterOf(changing[i]);
      if (!counter || isDeclared(loop.init, *counter)) continue;
      if (uniformity_.of(id_, *counter).front() == analysis::Shape::Uniform) continue;
      const Expr* const start = literalAfter(
          module_, assigns(module_, loop.init, *counter) ? std::span<const Stmt>(loop.init) : before,
          *counter);
      if (start == nullptr) continue;
      // the counter's only change is taken out to see what else the loop does with it
      Stmt change = std::move(changing[i]);
      const auto place = changing.erase(changing.begin() + static_cast<std::ptrdiff_t>(i));
      const bool isOnly = !assigns(module_, loop.body, *counter) && !assigns(module_, loop.step, *counter);
      if (isOnly && isRead(loop, *counter)) {
        const Loc loc = change.loc;
        const VarId count =
            addVariable(function_, "count", function_.variables[*counter].type, VarRole::Local, loc);
        declared.push_back(declare(count, clone(*start), loc));
        rename(loop, *counter, count);
        Stmt copy = clone(change);
        std::get<VarRef>(std::get<Assign>(copy.node).place->node).var = count;
        changing.insert(changing.insert(place, std::move(change)), std::move(copy));
        ++i;
      } else {
        changing.insert(place, std::move(change));
      }
    }
  }

  template <class Visit>
  static void forEachRead(Loop& loop, VarId var, Visit&& visit) {
    const auto check = [&](Expr& expr) {
      auto* const n = std::get_if<VarRef>(&expr.node);
      if (n != nullptr && n->var == var) visit(*n);
    };
    if (loop.cond) walkExprs(*loop.cond, check);
    walkExprs(loop.body, check);
    walkExprs(loop.step, check);
  }
  static bool isRead(Loop& loop, VarId var) {
    bool found = false;
    forEachRead(loop, var, [&](VarRef&) { found = true; });
    return found;
  }
  static void rename(Loop& loop, VarId from, VarId to) {
    forEachRead(loop, from, [&](VarRef& ref) { ref.var = to; });
  }

  const Module& module_;
  Function& function_;
  FunctionId id_;
  const analysis::Uniformity& uniformity_;
};

/// Copies the varying counters of the function's divergent loops if they start from a literal. Returns true if it
/// changed the function: `uniformity` does not describe it any more.
bool splitCounters(const Module& module, Function& function, FunctionId id,
                   const analysis::Uniformity& uniformity) {
  return CounterSplitter(module, function, id, uniformity).block(function.body);
}

}  // namespace

namespace {

/// True if a statement would have side effects, or might not end, in inactive lanes.
bool needsMask(const analysis::Uniformity& uniformity, FunctionId id, const Stmt& stmt) {
  if (std::holds_alternative<Push>(stmt.node) || std::holds_alternative<Scatter>(stmt.node) ||
      std::holds_alternative<Print>(stmt.node))
    return true;
  return std::holds_alternative<Loop>(stmt.node) && uniformity.diverges(id, stmt);
}

/// True if a mask lets a function skip a long branch that no active lane takes.
bool profitsFromMask(const Module& module, const analysis::Uniformity& uniformity, FunctionId id,
                     const Stmt& stmt) {
  const bool isBranch = std::holds_alternative<If>(stmt.node) || std::holds_alternative<Switch>(stmt.node);
  return isBranch && uniformity.diverges(id, stmt) && !isShort(module, {&stmt, 1});
}

template <class Fn>
bool anyStmt(const Block& block, Fn&& fn) {
  bool found = false;
  walkStmts(block, [&](const Stmt& stmt) { found = found || fn(stmt); });
  return found;
}

/// The functions that take a mask. `functions` lists callees before their callers.
std::set<FunctionId> maskedFunctions(const Module& module, const Kernel& kernel,
                                     const analysis::Uniformity& uniformity,
                                     const std::vector<FunctionId>& functions) {
  std::set<FunctionId> needing, masked;
  bool entryNeedsMask = false;
  for (const FunctionId id : functions) {
    const Function& function = module.functions[id];
    const bool must =
        anyStmt(function.body, [&](const Stmt& stmt) { return needsMask(uniformity, id, stmt); });
    entryNeedsMask = entryNeedsMask || must;
    const bool profits = anyStmt(
        function.body, [&](const Stmt& stmt) { return profitsFromMask(module, uniformity, id, stmt); });
    const bool callsNeeding =
        std::ranges::any_of(callees(function), [&](FunctionId callee) { return needing.contains(callee); });
    if (must || profits || callsNeeding) needing.insert(id);
  }
  if (entryNeedsMask) masked.insert(kernel.entry);
  for (const FunctionId id : functions | std::views::reverse) {
    if (id != kernel.entry && needing.contains(id) && uniformity.isCalledDivergently(id)) masked.insert(id);
    if (!masked.contains(id)) continue;
    for (const FunctionId callee : callees(module.functions[id])) {
      if (needing.contains(callee)) masked.insert(callee);
    }
  }
  return masked;
}

/// A violation is a bug of skc.
void validateOrAbort([[maybe_unused]] const Module& module) {
#ifndef NDEBUG
  const std::string violation = validatePredicated(module);
  if (!violation.empty()) internalError("invalid IR after predicate: " + violation);
#endif
}

}  // namespace

void predicate(Module& module) {
  std::set<FunctionId> isLong = longFunctions(module);
  for (const Kernel& kernel : module.kernels) {
    const std::vector<FunctionId> functions = functionsOf(module, kernel);
    for (const FunctionId id : functions) hoistCalls(module.functions[id], isLong);
    std::optional<analysis::Uniformity> known(std::in_place, module, kernel);
    bool isSplit = false;
    for (const FunctionId id : functions)
      isSplit = splitCounters(module, module.functions[id], id, *known) || isSplit;
    if (isSplit) known.emplace(module, kernel);
    const analysis::Uniformity& uniformity = *known;
    const PredicateContext context{module, uniformity, maskedFunctions(module, kernel, uniformity, functions),
                                   isLong};
    std::vector<Function> results;  // replaced at the end: the analysis identifies statements by address
    for (const FunctionId id : functions) results.push_back(predicated(context, id));
    for (std::size_t i = 0; i < functions.size(); ++i) module.functions[functions[i]] = std::move(results[i]);
  }
  validateOrAbort(module);
}

std::optional<VarId> entryMask(const Module& module, const Kernel& kernel) {
  const auto count = static_cast<VarId>(kernel.params.size());
  return module.functions[kernel.entry].parameterCount > count ? std::optional(count) : std::nullopt;
}

std::string validatePredicated(const Module& module) {
  std::string violation = validate(module, Stage::Predicated);
  for (const Kernel& kernel : module.kernels) {
    if (!violation.empty()) return violation;
    const analysis::Uniformity uniformity(module, kernel);
    for (const FunctionId id : functionsOf(module, kernel)) {
      const Function& function = module.functions[id];
      walkStmts(function.body, [&](const Stmt& stmt) {
        if (!violation.empty() || !uniformity.diverges(id, stmt)) return;
        violation = fmt::format("kernel {}: function @{} '{}': line {}: control flow diverges", kernel.name,
                                id, function.name, stmt.loc.line);
      });
    }
  }
  return violation;
}

}  // namespace skc
