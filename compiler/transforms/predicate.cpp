// SPDX-License-Identifier: MIT
#include "transforms/predicate.hpp"

#include <algorithm>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "analysis/uniformity.hpp"
#include "ir/call_graph.hpp"
#include "ir/validate.hpp"
#include "ir/walk.hpp"
#include "support/internal_error.hpp"
#include "transforms/hoist_expressions.hpp"
#include "transforms/predicate_function.hpp"
#include "transforms/split_counters.hpp"

namespace skc {

using namespace ir;

namespace {

/// True if a statement would have side effects, or might not end, in inactive lanes.
bool needsMask(const analysis::Uniformity& uniformity, FunctionId id, const Stmt& stmt) {
  if (std::holds_alternative<Push>(stmt.node) || std::holds_alternative<Scatter>(stmt.node)) return true;
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
      isSplit = splitCounters(module.functions[id], id, *known) || isSplit;
    if (isSplit) known.emplace(module, kernel);
    const analysis::Uniformity& uniformity = *known;
    const PredicateContext context{module, uniformity, maskedFunctions(module, kernel, uniformity, functions),
                                   isLong};
    std::vector<Function> results;   // replaced at the end: the analysis identifies statements by address
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
