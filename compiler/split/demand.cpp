// SPDX-License-Identifier: MIT
#include "split/demand.hpp"

#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "split/cost.hpp"

namespace skc::split {

using namespace ir;

namespace {

/// The kernel parameter whose stream an expression reads or queries.
std::optional<std::uint32_t> streamOf(const Expr& expr) {
  std::optional<StreamRef> stream;
  if (const auto* n = std::get_if<GatherRead>(&expr.node)) stream = n->stream;
  if (const auto* n = std::get_if<NeighborRead>(&expr.node)) stream = n->stream;
  if (const auto* n = std::get_if<Sample>(&expr.node)) stream = n->stream;
  if (const auto* n = std::get_if<IndexOf>(&expr.node)) stream = n->stream;
  if (const auto* n = std::get_if<ExtentOf>(&expr.node)) stream = n->stream;
  if (!stream || stream->space != StreamRef::Space::KernelParameter) return std::nullopt;
  return stream->id;
}

void unite(VarSet& set, const VarSet& other) {
  for (std::size_t i = 0; i < set.size(); ++i) set[i] = set[i] || other[i];
}

}  // namespace

Demand::Demand(const Module& module, const Kernel& kernel) : module_(module), kernel_(kernel) {
  for (FunctionId id : functionsOf(module, kernel)) {   // callees first
    VarSet params(kernel.params.size(), false);
    if (id != kernel.entry) {
      walkStmts(module.functions[id].body, [&](const Stmt& stmt) { collect(stmt, params); });
    }
    functions_[id] = std::move(params);
  }
  walkStmts(module.functions[kernel.entry].body, [&](const Stmt& stmt) {
    VarSet params(kernel.params.size(), false);
    collect(stmt, params);
    for (VarId i = 0; i < params.size(); ++i) {
      if (params[i]) streams_[&stmt].push_back(i);
    }
  });
}

void Demand::collect(const Stmt& stmt, VarSet& params) const {
  if (const auto* n = std::get_if<CallStmt>(&stmt.node)) unite(params, functions_.at(n->callee));
  forEachOperand(stmt, [&](const ExprPtr& operand) { collect(*operand, params); });
}

void Demand::collect(const Expr& expr, VarSet& params) const {
  walkExprs(expr, [&](const Expr& inner) {
    if (const auto* n = std::get_if<Call>(&inner.node)) unite(params, functions_.at(n->callee));
    if (const std::optional<std::uint32_t> param = streamOf(inner)) params[*param] = true;
  });
}

VarSet Demand::params(const Slice& slice) const {
  VarSet params(kernel_.params.size(), false);
  for (std::size_t i = 0; i < params.size(); ++i) {
    const ParamRole role = kernel_.params[i].role;
    // conditions (neededIf) may depend on any Spec parameter
    params[i] = role == ParamRole::Spec || (slice.used[i] && role != ParamRole::Output);
  }
  for (const Stmt* stmt : slice.kept) {
    const auto streams = streams_.find(stmt);
    if (streams == streams_.end()) continue;
    for (const VarId param : streams->second) params[param] = true;
  }
  return params;
}

bool isRead(const KernelParam& param) {
  return param.role == ParamRole::Input || param.role == ParamRole::Gather;
}

Limits demandOf(const Module& module, const Kernel& kernel) {
  Limits demand;
  for (const KernelParam& param : kernel.params) {
    const auto planes = static_cast<std::uint32_t>(planesOf(module, heldType(param)).size());
    if (param.role == ParamRole::Output) demand.drawBuffers += planes;
    if (isRead(param)) demand.textureUnits += planes;
  }
  return demand;
}

}  // namespace skc::split
