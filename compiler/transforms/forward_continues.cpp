// SPDX-License-Identifier: MIT
#include "transforms/passes.hpp"

#include <utility>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

class Forwarder {
 public:
  explicit Forwarder(Function& function) : function_(function) {}

  /// `switches`: the number of switches around the block, within its loop.
  void block(Block& statements, int switches) {
    for (Stmt& stmt : statements) {
      if (std::holds_alternative<Loop>(stmt.node)) {
        forEachBlock(stmt, [&](Block& inner) { block(inner, 0); });
      } else if (std::holds_alternative<Switch>(stmt.node)) {
        choice(stmt, switches);
      } else {
        forEachBlock(stmt, [&](Block& inner) { block(inner, switches); });
      }
    }
  }

 private:
  /// Rewrites inner switches first: each leaves a `continue` behind it for the switch around it.
  void choice(Stmt& stmt, int switches) {
    forEachBlock(stmt, [&](Block& inner) { block(inner, switches + 1); });
    if (switches == 0 || !continues(stmt)) return;
    const Loc loc = stmt.loc;
    const VarId flag = addVariable(function_, "continues", Type::of(Scalar::Bool), VarRole::Local, loc);
    forEachBlock(stmt, [&](Block& inner) { leave(inner, flag); });
    stmt = scope(ir::block(declare(flag, literal(false, loc), loc), std::move(stmt),
                           ifStmt(varRef(function_, flag, loc), ir::block(continueStmt(loc)), {}, loc)),
                 loc);
  }

  /// True if a statement contains a `continue` of the loop around the statement.
  static bool continues(const Stmt& stmt) {
    if (std::holds_alternative<Continue>(stmt.node)) return true;
    if (std::holds_alternative<Loop>(stmt.node)) return false;
    bool found = false;
    forEachBlock(stmt, [&](const Block& inner) {
      for (const Stmt& one : inner) found = found || continues(one);
    });
    return found;
  }

  /// Turns each `continue` of the loop around the switch into a break of the switch that sets the flag. Inner
  /// switches contain none any more.
  void leave(Block& statements, VarId flag) {
    for (Stmt& stmt : statements) {
      if (std::holds_alternative<Loop>(stmt.node)) continue;
      forEachBlock(stmt, [&](Block& inner) { leave(inner, flag); });
      if (!std::holds_alternative<Continue>(stmt.node)) continue;
      const Loc loc = stmt.loc;
      stmt = scope(ir::block(assign(varRef(function_, flag, loc), literal(true, loc), loc), breakStmt(loc)),
                   loc);
    }
  }

  Function& function_;
};

}  // namespace

void forwardContinues(Module& module, Diagnostics&) {
  for (Function& function : module.functions) Forwarder(function).block(function.body, 0);
}

}  // namespace skc
