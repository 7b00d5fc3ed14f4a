// SPDX-License-Identifier: MIT
#include "glsl/loop_steps.hpp"

#include <set>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::emit {
namespace {

using namespace ir;

/// How a block may leave the loop around it.
struct Exits {
  bool returns = false, breaks = false;
};

/// `isInner`: a `break` leaves something in that loop.
void findExits(const Block& statements, bool isInner, Exits& exits) {
  for (const Stmt& stmt : statements) {
    exits.returns = exits.returns || std::holds_alternative<Return>(stmt.node);
    exits.breaks = exits.breaks || (!isInner && std::holds_alternative<Break>(stmt.node));
    const bool catches = std::holds_alternative<Loop>(stmt.node) || std::holds_alternative<Switch>(stmt.node);
    forEachBlock(stmt, [&](const Block& inner) { findExits(inner, isInner || catches, exits); });
  }
}

/// True if the step is one assignment to a variable that the condition reads, as in `for (i = 0; i < n; ++i)`.
bool onlyCounts(const Loop& loop) {
  const auto* step = loop.step.size() == 1 ? std::get_if<Assign>(&loop.step[0].node) : nullptr;
  const auto* counter = step != nullptr ? std::get_if<VarRef>(&step->place->node) : nullptr;
  if (counter == nullptr || !loop.cond) return false;
  bool isRead = false;
  walkExprs(*loop.cond, [&](const Expr& expr) {
    const auto* n = std::get_if<VarRef>(&expr.node);
    isRead = isRead || (n != nullptr && n->var == counter->var);
  });
  return isRead;
}

/// What a loop's step changes.
class Changes {
 public:
  Changes(const Module& module, const Loop& loop) : module_(module) {
    for (const Block* block : {&loop.init, &loop.step}) {
      walkStmts(*block, [&](const Stmt& stmt) {
        if (const auto* n = std::get_if<Declare>(&stmt.node)) own_.insert(n->var);
      });
    }
    walkStmts(loop.step, [&](const Stmt& stmt) { add(stmt); });
  }

  /// True if that is more than variables of the loop.
  bool areLasting() const { return areLasting_; }

 private:
  void add(const Stmt& stmt) {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) {
      write(*n->place);
    } else if (const auto* call = std::get_if<CallStmt>(&stmt.node)) {
      if (call->result) write(*call->result);
      const Function& callee = module_.functions[call->callee];
      for (VarId i = 0; i < call->args.size(); ++i) {
        const VarRole role = callee.variables[i].role;
        if (role == VarRole::InOut) write(*call->args[i]);
        areLasting_ = areLasting_ || role == VarRole::AppendOutput;
      }
    } else if (std::holds_alternative<Push>(stmt.node) || std::holds_alternative<Scatter>(stmt.node)) {
      areLasting_ = true;
    }
  }

  void write(const Expr& place) { areLasting_ = areLasting_ || !own_.contains(rootOf(place)); }

  const Module& module_;
  std::set<VarId> own_;
  bool areLasting_ = false;
};

}  // namespace

bool stepShowsAfterJump(const Module& module, const Loop& loop) {
  if (loop.step.empty()) return false;
  Exits exits;
  findExits(loop.body, false, exits);
  const bool isWrong = exits.returns || (exits.breaks && !onlyCounts(loop));
  return isWrong && Changes(module, loop).areLasting();
}

}  // namespace skc::emit
