// SPDX-License-Identifier: MIT
#include "native/row_plan.hpp"

#include <algorithm>
#include <vector>

#include "ir/lvalue.hpp"
#include "ir/walk.hpp"
#include "native/leaves.hpp"
#include "support/overloaded.hpp"

namespace skc::native {

using namespace ir;
using analysis::Axis;
using analysis::Shape;
using analysis::Uniformity;

namespace {

bool isControl(const Stmt& stmt) {
  return std::holds_alternative<If>(stmt.node) || std::holds_alternative<Loop>(stmt.node) ||
         std::holds_alternative<Switch>(stmt.node) || std::holds_alternative<Scope>(stmt.node);
}

/// Calls visit(variable) for each variable that the statement itself declares or changes.
template <class Visit>
void forEachSet(const Module& module, const Stmt& stmt, const Visit& visit) {
  if (const auto* n = std::get_if<Declare>(&stmt.node)) visit(n->var);
  forEachAssigned(module, stmt, visit);
}

/// Calls visit(loop) for each loop that all rows run through together, including inner ones.
template <class Visit>
void forEachLoopEmittedOnce(const RowPlan& plan, const Block& body, Visit&& visit) {
  for (const Stmt& stmt : body) {
    if (!isControl(stmt) || !plan.isEmittedOnce(stmt)) continue;
    if (std::holds_alternative<Loop>(stmt.node)) visit(stmt);
    forEachBlock(stmt, [&](const Block& inner) { forEachLoopEmittedOnce(plan, inner, visit); });
  }
}

}  // namespace

RowPlan::RowPlan(const Module& module, const Kernel& kernel)
    : module_(module),
      kernel_(kernel),
      entry_(module.functions[kernel.entry]),
      rows_(module, kernel, Axis::Y) {
  for (VarId var = 0; var < entry_.variables.size(); ++var) {
    const auto shapes = rows_.of(kernel.entry, var);
    const bool isOutput = var < kernel.params.size() && kernel.params[var].role == ParamRole::Output;
    if (isOutput || std::ranges::any_of(shapes, [](Shape shape) { return shape != Shape::Uniform; }))
      perRow_.insert(var);
  }
  // the rows run divergent code one after the other; what one row assigns there must not reach the next
  for (std::size_t before = 0; before != perRow_.size();) {
    before = perRow_.size();
    addAssigned(entry_.body, false);
  }
}

void RowPlan::addAssigned(const Block& body, bool isDivergent) {
  for (const Stmt& stmt : body) {
    if (isDivergent || !isEmittedOnce(stmt)) addAssignedBy(stmt);
    forEachBlock(stmt, [&](const Block& inner) {
      addAssigned(inner, isDivergent || (isControl(stmt) && !isEmittedOnce(stmt)));
    });
  }
}

void RowPlan::addAssignedBy(const Stmt& stmt) {
  forEachSet(module_, stmt, [&](VarId var) { perRow_.insert(var); });
}

bool RowPlan::isEmittedOnce(const Stmt& stmt) const {
  if (isControl(stmt)) return !rows_.diverges(kernel_.entry, stmt) && !rows_.skips(kernel_.entry, stmt);
  bool isEmittedOnce = true;
  forEachSet(module_, stmt, [&](VarId var) { isEmittedOnce = isEmittedOnce && !isPerRow(var); });
  return isEmittedOnce;
}

bool RowPlan::isShared(const Expr& expr) const { return rows_.of(kernel_.entry, expr) == Shape::Uniform; }

std::set<std::uint32_t> RowPlan::sharedGathers(const Uniformity& lanes) const {
  std::set<std::uint32_t> shared;
  const bool isElementwise =
      !kernel_.reduction && std::ranges::none_of(kernel_.params, [](const KernelParam& p) {
        return p.role == ParamRole::VariableOutput || p.role == ParamRole::Scatter;
      });
  if (!isElementwise || rows_.returnsEarly(kernel_.entry)) return shared;
  forEachLoopEmittedOnce(*this, entry_.body, [&](const Stmt& loop) {
    for (const Stmt& stmt : std::get<Loop>(loop.node).body) {
      forEachOperand(stmt, [&](const ExprPtr& operand) {
        walkExprs(*operand, [&](const Expr& expr) {
          const auto* n = std::get_if<GatherRead>(&expr.node);
          if (n != nullptr && isShared(expr) && lanes.of(kernel_.entry, expr) != Shape::Uniform)
            shared.insert(n->stream.id);
        });
      });
    }
  });
  return shared;
}

std::uint32_t RowPlan::carried() const {
  std::set<VarId> assigned, inner;
  forEachLoopEmittedOnce(*this, entry_.body, [&](const Stmt& loop) {
    walkStmts(std::get<Loop>(loop.node).body, [&](const Stmt& stmt) {
      if (const auto* n = std::get_if<Declare>(&stmt.node)) inner.insert(n->var);
      forEachSet(module_, stmt, [&](VarId var) { assigned.insert(var); });
    });
  });
  std::uint32_t words = 0;
  for (const VarId var : assigned) {
    if (!isPerRow(var) || inner.contains(var)) continue;
    for (const Scalar scalar : scalarsOf(module_, entry_.variables[var].type))
      words += is64Bit(scalar) ? 2 : 1;
  }
  return words;
}

RowBlock blockFor(const CpuLevel& level, std::uint32_t carried) {
  const std::uint32_t lanes = level.vectorBits / 32;
  const auto mostRows = static_cast<std::uint32_t>(sk::native::mostRows);
  // Two vectors of sums in each row. LLVM loads what each row reads itself, for all rows, before the first product: with
  // more rows it spills sums in every iteration.
  if (carried <= 1) return {2 * lanes, std::min(level.vectorRegisters / 3, mostRows)};
  // What rows share takes as many registers as one row carries; a row's own reads take three more.
  const std::uint32_t free = level.vectorRegisters - 3;
  const std::uint32_t rows = free > 2 * carried ? (free - carried) / carried : 1;
  return {lanes, std::min(rows, mostRows)};
}

}  // namespace skc::native
