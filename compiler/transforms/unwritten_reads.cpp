// SPDX-License-Identifier: MIT
#include "transforms/unwritten_reads.hpp"

#include <set>

#include "ir/build.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc {
namespace {

using namespace ir;

/// Follows one function in source order, which is execution order except for loops.
class Reader {
 public:
  /// `callees` has the reads of the functions before this one.
  Reader(const Module& module, const Function& function, bool isKernel,
         const std::vector<UnwrittenReads>& callees)
      : module_(module), function_(function), isKernel_(isKernel), callees_(callees) {}

  UnwrittenReads run() {
    follow(function_.body);
    return std::move(reads_);
  }

 private:
  void read(VarId var, Loc loc) {
    if (var >= function_.parameterCount || function_.variables[var].role != VarRole::InOut) return;
    // A caller may know that a conditional read in a helper does not happen.
    const bool isCertain = isKernel_ || depth_ == 0;
    if (isCertain && !written_.contains(var)) reads_.try_emplace(var, loc);
  }
  void read(const Expr& expr) {
    walkExprs(expr, [&](const Expr& one) {
      if (const auto* reference = std::get_if<VarRef>(&one.node)) read(reference->var, one.loc);
    });
  }
  void read(const ExprPtr& expr) {
    if (expr) read(*expr);
  }
  /// Writing to `a[i].x` reads i.
  void readIndices(const Expr& place) {
    if (const auto* swizzle = std::get_if<Swizzle>(&place.node)) readIndices(*swizzle->base);
    if (const auto* member = std::get_if<Member>(&place.node)) readIndices(*member->base);
    if (const auto* index = std::get_if<Index>(&place.node)) {
      readIndices(*index->base);
      read(*index->index);
    }
  }

  void follow(const Block& block) {
    for (const Stmt& stmt : block) {
      match(stmt.node, [&](const auto& node) { step(node, stmt); });
    }
  }

  void step(const Declare& n, const Stmt&) { read(n.init); }
  void step(const Assign& n, const Stmt&) {
    read(*n.value);
    readIndices(*n.place);
    if (n.op) {
      read(rootOf(*n.place), n.place->loc);
    } else {
      written_.insert(rootOf(*n.place));
    }
  }
  void step(const CallStmt& n, const Stmt&) {
    const Function& callee = module_.functions[n.callee];
    for (VarId i = 0; i < callee.parameterCount; ++i) {
      const Expr& argument = *n.args[i];
      if (callee.variables[i].role != VarRole::InOut) {
        read(argument);
      } else {
        readIndices(argument);
        if (callees_[n.callee].contains(i)) read(rootOf(argument), argument.loc);
      }
    }
    markWritten(n);
  }
  void followConditional(const Block& block) {
    ++depth_;
    follow(block);
    --depth_;
  }

  void step(const If& n, const Stmt&) {
    read(*n.cond);
    followConditional(n.then);
    followConditional(n.otherwise);
  }
  void step(const Loop& n, const Stmt& stmt) {
    follow(n.init);
    forEachBlock(stmt, [&](const Block& block) { markWritten(block); });
    read(n.cond);
    followConditional(n.body);
    followConditional(n.step);
  }
  void step(const Switch& n, const Stmt&) {
    read(*n.value);
    for (const Case& one : n.cases) followConditional(one.body);
  }
  void step(const Break&, const Stmt&) {}
  void step(const Continue&, const Stmt&) {}
  void step(const Return& n, const Stmt&) { read(n.value); }
  void step(const Scope& n, const Stmt&) { follow(n.body); }
  void step(const Push& n, const Stmt&) { read(*n.value); }
  void step(const Scatter& n, const Stmt&) {
    read(*n.index);
    read(*n.value);
  }

  void markWritten(const CallStmt& n) {
    const Function& callee = module_.functions[n.callee];
    for (VarId i = 0; i < callee.parameterCount; ++i) {
      if (callee.variables[i].role == VarRole::InOut) written_.insert(rootOf(*n.args[i]));
    }
    if (n.result) written_.insert(rootOf(*n.result));
  }
  void markWritten(const Block& block) {
    walkStmts(block, [&](const Stmt& stmt) {
      if (const auto* call = std::get_if<CallStmt>(&stmt.node)) markWritten(*call);
      const auto* assign = std::get_if<Assign>(&stmt.node);
      if (assign != nullptr && !assign->op) written_.insert(rootOf(*assign->place));
    });
  }

  const Module& module_;
  const Function& function_;
  const bool isKernel_;
  const std::vector<UnwrittenReads>& callees_;
  std::set<VarId> written_;
  UnwrittenReads reads_;
  int depth_ = 0;  ///< number of branches and loops around
};

}  // namespace

std::vector<UnwrittenReads> unwrittenReads(const Module& module) {
  std::set<FunctionId> kernels;
  for (const Kernel& kernel : module.kernels) kernels.insert(kernel.entry);
  std::vector<UnwrittenReads> reads;  // callees precede their callers in the module
  for (const Function& function : module.functions) {
    const bool isKernel = kernels.contains(static_cast<FunctionId>(reads.size()));
    reads.push_back(Reader(module, function, isKernel, reads).run());
  }
  return reads;
}

}  // namespace skc
