// SPDX-License-Identifier: MIT
#include "split/slice.hpp"

#include <algorithm>
#include <optional>
#include <ranges>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"
#include "split/cost.hpp"
#include "support/overloaded.hpp"

namespace skc::split {

using namespace ir;

namespace {

/// fn(var) for each variable that a call writes through InOut parameters or its result.
template <class Fn>
void forEachWritten(const Module& module, const CallStmt& call, Fn&& fn) {
  const Function& callee = module.functions[call.callee];
  for (std::size_t i = 0; i < call.args.size(); ++i) {
    if (callee.variables[i].role == VarRole::InOut) fn(rootOf(*call.args[i]));
  }
  if (call.result) fn(rootOf(*call.result));
}

/// Marks the statements that a slice needs, up to a fixed point. Goes backwards, from uses to what they use, so that few rounds
/// are needed.
class Marker {
 public:
  Marker(const Module& module, const Function& function, const Slicer& slicer, const VarSet& wanted,
         const VarSet& loadable)
      : module_(module), function_(function), slicer_(slicer), loadable_(loadable) {
    slice_.used = wanted;
    slice_.loaded.assign(wanted.size(), false);
    for (VarId var = 0; var < wanted.size(); ++var) {
      if (wanted[var]) end_ = std::max(end_, slicer.lastWrite(var) + 1);
    }
    end_ = std::min(end_, function.body.size());
  }

  /// Returns the slice, or sets `early` to a variable that it would have to load before that is final.
  Slice run(std::optional<VarId>& early) {
    do {
      changed_ = false;
      for (top_ = end_; top_-- > 0;) visit(function_.body[top_], {});
    } while (changed_ && !early_);
    early = early_;
    return std::move(slice_);
  }

 private:
  /// Whether a `break` or a `continue` at this point leaves a statement that is needed.
  struct Jumps {
    bool breaks = false, continues = false;
  };

  bool isComputed(VarId var) const { return slice_.used[var] && !loadable_[var]; }

  void read(const Expr& expr) {
    walkExprs(expr, [&](const Expr& inner) {
      if (const auto* n = std::get_if<VarRef>(&inner.node)) use(n->var);
    });
  }

  void use(VarId var) {
    if (loadable_[var]) {
      slice_.loaded[var] = true;
      if (top_ <= slicer_.lastWrite(var)) early_ = var;
    }
    changed_ = changed_ || !slice_.used[var];
    slice_.used[var] = true;
  }

  bool visit(const Block& block, Jumps jumps) {
    bool needed = false;
    for (const Stmt& stmt : std::views::reverse(block)) needed = visit(stmt, jumps) || needed;
    return needed;
  }

  bool visit(const Stmt& stmt, Jumps jumps) {
    isKept_ = slice_.kept.contains(&stmt);
    const bool needed = match(stmt.node, [&](const auto& node) { return step(node, jumps); });
    if (needed) changed_ = slice_.kept.insert(&stmt).second || changed_;
    return needed;
  }

  bool step(const Declare& n, Jumps) {
    if (!isComputed(n.var)) return false;
    if (n.init) read(*n.init);
    return true;
  }
  bool step(const Assign& n, Jumps) {
    if (!isComputed(rootOf(*n.place))) return false;
    read(*n.place);
    read(*n.value);
    return true;
  }
  bool step(const CallStmt& n, Jumps) {
    bool needed = false;
    forEachWritten(module_, n, [&](VarId var) { needed = needed || isComputed(var); });
    if (!needed) return false;
    for (const ExprPtr& arg : n.args) read(*arg);
    if (n.result) read(*n.result);
    return true;
  }
  bool step(const If& n, Jumps jumps) {
    const bool then = visit(n.then, jumps), otherwise = visit(n.otherwise, jumps);
    if (then || otherwise) read(*n.cond);
    return then || otherwise;
  }
  /// The jumps out of a statement count from the round after that in which the statement was found to be needed. (To visit it
  /// twice in one round would take time exponential in the nesting.)
  bool step(const Loop& n, Jumps) {
    const Jumps jumps{isKept_, isKept_};
    const bool step = visit(n.step, {}), body = visit(n.body, jumps);
    if (!step && !body && !jumps.breaks) return false;
    if (n.cond) read(*n.cond);
    visit(n.init, {});
    return true;
  }
  bool step(const Switch& n, Jumps jumps) {
    bool needed = isKept_;
    const Jumps inner{isKept_, jumps.continues};
    for (const Case& one : std::views::reverse(n.cases)) needed = visit(one.body, inner) || needed;
    if (needed) read(*n.value);
    return needed;
  }
  bool step(const Break&, Jumps jumps) { return jumps.breaks; }
  bool step(const Continue&, Jumps jumps) { return jumps.continues; }
  bool step(const Return&, Jumps) { return true; }  // kept, so that nothing after it runs
  bool step(const Scope& n, Jumps jumps) { return visit(n.body, jumps); }
  bool step(const Push& n, Jumps) {  // kept, since it has a side effect
    read(*n.value);
    return true;
  }
  bool step(const Scatter& n, Jumps) {
    read(*n.index);
    read(*n.value);
    return true;
  }
  bool step(const Print&, Jumps) { return false; }  // slices are for programs that do not print

  const Module& module_;
  const Function& function_;
  const Slicer& slicer_;
  const VarSet& loadable_;
  Slice slice_;
  std::size_t end_ = 0;  ///< statements after the last write of a wanted variable are dropped
  std::size_t top_ = 0;
  bool isKept_ = false;  ///< whether the statement that is visited is already known to be needed
  bool changed_ = false;
  std::optional<VarId> early_;
};

Block copyKept(const Block& block, const Slice& slice);

Stmt copyKept(const Stmt& stmt, const Slice& slice) {
  const auto blockOf = [&](const Block& inner) { return copyKept(inner, slice); };
  Stmt::Node node = match(
      stmt.node,
      [&](const If& n) -> Stmt::Node { return If{clone(n.cond), blockOf(n.then), blockOf(n.otherwise)}; },
      [&](const Loop& n) -> Stmt::Node {
        return Loop{n.kind, blockOf(n.init), clone(n.cond), blockOf(n.step), blockOf(n.body)};
      },
      [&](const Switch& n) -> Stmt::Node {
        Switch result{clone(n.value), {}};
        for (const Case& one : n.cases) {
          result.cases.push_back({one.values, one.isDefault, blockOf(one.body), one.loc});
        }
        return result;
      },
      [&](const Scope& n) -> Stmt::Node { return Scope{blockOf(n.body)}; },
      [&](const auto&) -> Stmt::Node { return clone(stmt).node; });
  return {stmt.loc, std::move(node)};
}

Block copyKept(const Block& block, const Slice& slice) {
  Block result;
  for (const Stmt& stmt : block) {
    if (slice.kept.contains(&stmt)) result.push_back(copyKept(stmt, slice));
  }
  return result;
}

}  // namespace

Slicer::Slicer(const Module& module, const Function& function)
    : module_(module), function_(function), lastWrites_(function.variables.size(), 0) {
  for (std::size_t top = 0; top < function.body.size(); ++top) {
    const auto visit = [&](const Stmt& stmt) {
      if (const auto* n = std::get_if<Declare>(&stmt.node)) lastWrites_[n->var] = top;
      if (const auto* n = std::get_if<Assign>(&stmt.node)) lastWrites_[rootOf(*n->place)] = top;
      if (const auto* n = std::get_if<CallStmt>(&stmt.node)) {
        forEachWritten(module, *n, [&](VarId var) { lastWrites_[var] = top; });
      }
    };
    visit(function.body[top]);
    forEachBlock(function.body[top], [&](const Block& inner) { walkStmts(inner, visit); });
  }
}

Slice Slicer::slice(const VarSet& wanted, VarSet loadable) const {
  for (;;) {
    std::optional<VarId> early;
    Slice result = Marker(module_, function_, *this, wanted, loadable).run(early);
    if (!early) return result;
    loadable[*early] = false;
  }
}

Block Slicer::copy(const Slice& slice) const { return copyKept(function_.body, slice); }

std::optional<Loc> firstRead(VarId var, const Slice& slice) {
  std::optional<Loc> first;
  const auto isEarlier = [&](Loc loc) { return loc.line != 0 && (!first || loc.line < first->line); };
  for (const Stmt* stmt : slice.kept) {
    forEachOperand(*stmt, [&](const ExprPtr& operand) {
      if (const auto* n = std::get_if<VarRef>(&operand->node); n != nullptr && n->var == var) {
        if (std::holds_alternative<Assign>(stmt->node) &&
            operand.get() == std::get<Assign>(stmt->node).place.get())
          return;
      }
      walkExprs(*operand, [&](const Expr& expr) {
        const auto* n = std::get_if<VarRef>(&expr.node);
        if (n != nullptr && n->var == var && isEarlier(expr.loc)) first = expr.loc;
      });
    });
  }
  return first;
}

namespace {

void unite(VarSet& set, const VarSet& other) {
  for (std::size_t i = 0; i < set.size(); ++i) set[i] = set[i] || other[i];
}

}  // namespace

Demand::Demand(const Module& module, const Kernel& kernel) : module_(module), kernel_(kernel) {
  for (FunctionId id : functionsOf(module, kernel)) {  // callees first
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
    const StreamRef* stream = streamOf(inner);
    if (stream != nullptr && stream->space == StreamRef::Space::KernelParameter) params[stream->id] = true;
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
