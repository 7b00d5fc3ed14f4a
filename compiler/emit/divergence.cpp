// SPDX-License-Identifier: MIT
#include "emit/divergence.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "ir/reach.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::emit {

using namespace ir;

namespace {

/// The variable that a place is, or is a part of.
VarId rootOf(const Expr& place) {
  if (const auto* n = std::get_if<Swizzle>(&place.node)) return rootOf(*n->base);
  if (const auto* n = std::get_if<Member>(&place.node)) return rootOf(*n->base);
  if (const auto* n = std::get_if<Index>(&place.node)) return rootOf(*n->base);
  return std::get<VarRef>(place.node).var;
}

/// Which component an index names, where that is written in the program.
std::optional<std::uint8_t> literalComponent(const Expr& index) {
  const auto* n = std::get_if<Literal>(&index.node);
  return n != nullptr && n->bits < 4 ? std::optional(static_cast<std::uint8_t>(n->bits)) : std::nullopt;
}

/// Where the variables of a function are used for the last time, and where its loops end, counting statements.
struct Order {
  std::vector<std::size_t> lastUse;
  std::map<const Stmt*, std::size_t> ends;  ///< of loops
  std::set<VarId> assigned;

  explicit Order(const Module& module, const Function& function) : lastUse(function.variables.size(), 0) {
    visit(module, function.body);
  }

 private:
  void visit(const Module& module, const Block& block) {
    for (const Stmt& stmt : block) {
      ++now_;
      forEachOperand(stmt, [&](const ExprPtr& operand) {
        walkExprs(static_cast<const Expr&>(*operand), [&](const Expr& expr) {
          if (const auto* n = std::get_if<VarRef>(&expr.node)) lastUse[n->var] = now_;
        });
      });
      if (const auto* n = std::get_if<Assign>(&stmt.node)) assigned.insert(rootOf(*n->place));
      if (const auto* n = std::get_if<CallStmt>(&stmt.node)) {
        const Function& callee = module.functions[n->callee];
        for (std::size_t i = 0; i < n->args.size(); ++i) {
          if (callee.variables[i].role == VarRole::InOut) assigned.insert(rootOf(*n->args[i]));
        }
        if (n->result) assigned.insert(rootOf(*n->result));
      }
      forEachBlock(stmt, [&](const Block& inner) { visit(module, inner); });
      const auto* loop = std::get_if<Loop>(&stmt.node);
      if (loop == nullptr) continue;
      ++now_;
      if (loop->cond) {
        walkExprs(static_cast<const Expr&>(*loop->cond), [&](const Expr& expr) {
          if (const auto* n = std::get_if<VarRef>(&expr.node)) lastUse[n->var] = now_;
        });
      }
      ends[&stmt] = now_;
    }
  }

  std::size_t now_ = 0;
};

}  // namespace

bool FunctionDivergence::differs() const {
  return result || std::ranges::find(variables, true) != variables.end();
}

bool Divergence::isIndex(FunctionId function, VarId var) const {
  const auto found = indices_.find(function);
  return found != indices_.end() && found->second.contains(var);
}

bool Divergence::isInStep(FunctionId function, VarId var) const {
  const auto found = inStep_.find(function);
  return found != inStep_.end() && found->second.contains(var);
}

/// Whether a component of a vector is x of the domain's index. That of an input may be another one, and repeat.
bool Divergence::isFirstComponent(FunctionId function, const Expr& vector, std::uint8_t component) const {
  if (const auto* n = std::get_if<IndexOf>(&vector.node)) {
    const bool isOfInput = n->stream.space == StreamRef::Space::KernelParameter &&
                           kernel_.params[n->stream.id].role == ParamRole::Input;
    return component == 0 && !isOfInput;
  }
  const auto* n = std::get_if<VarRef>(&vector.node);
  if (n == nullptr || !isIndex(function, n->var)) return false;
  const Expr* init = constant_.at(function).at(n->var);
  if (const auto* swizzle = std::get_if<Swizzle>(&init->node)) init = swizzle->base.get();
  return isFirstComponent(function, *init, indices_.at(function).at(n->var)[component]);
}

bool Divergence::isRamp(FunctionId function, VarId var) const {
  const auto constants = constant_.find(function);
  if (constants == constant_.end()) return false;
  const auto found = constants->second.find(var);
  return found != constants->second.end() && isRamp(function, *found->second);
}

bool Divergence::isRamp(FunctionId function, const Expr& expr) const {
  if (expr.type != Type::of(Scalar::Int)) return false;
  if (const auto* n = std::get_if<VarRef>(&expr.node)) return isRamp(function, n->var);
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    return isFirstComponent(function, *n->base, n->components[0]);
  }
  if (const auto* n = std::get_if<Index>(&expr.node)) {
    const std::optional<std::uint8_t> component = literalComponent(*n->index);
    return component && n->base->type.isVector() && *component < n->base->type.width &&
           isFirstComponent(function, *n->base, *component);
  }
  const auto* n = std::get_if<Binary>(&expr.node);
  if (n == nullptr || (n->op != BinaryOp::Add && n->op != BinaryOp::Sub)) return false;
  if (isRamp(function, *n->lhs)) return !differs(function, *n->rhs);
  return n->op == BinaryOp::Add && !differs(function, *n->lhs) && isRamp(function, *n->rhs);
}

bool Divergence::differs(FunctionId function, const Expr& expr) const {
  const auto any = [&] {
    bool found = false;
    forEachOperand(expr, [&](const ExprPtr& operand) { found = found || differs(function, *operand); });
    return found;
  };
  /// Whether components of `base` are components of the index other than x.
  const auto areUniform = [&](const Expr& base, const std::vector<std::uint8_t>& components) {
    if (std::holds_alternative<IndexOf>(base.node))
      return std::ranges::find(components, 0) == components.end();
    const auto* n = std::get_if<VarRef>(&base.node);
    if (n == nullptr || !isIndex(function, n->var)) return false;
    const std::vector<std::uint8_t>& own = indices_.at(function).at(n->var);
    return std::ranges::none_of(components, [&](std::uint8_t c) { return own[c] == 0; });
  };
  if (const auto* n = std::get_if<VarRef>(&expr.node)) {
    const bool isSame = isInStep(function, n->var) && inStep_.at(function).at(n->var).reads.contains(&expr);
    return !isSame && differs(function, n->var);
  }
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    return !areUniform(*n->base, n->components) && differs(function, *n->base);
  }
  if (const auto* n = std::get_if<Index>(&expr.node)) {
    const std::optional<std::uint8_t> component = literalComponent(*n->index);
    if (component && *component < n->base->type.width && n->base->type.isVector() &&
        areUniform(*n->base, {*component}))
      return false;
  }
  if (std::holds_alternative<IndexOf>(expr.node) || std::holds_alternative<NeighborRead>(expr.node))
    return true;
  if (const auto* n = std::get_if<Call>(&expr.node)) return of(n->callee).result || any();
  return any();
}

/// One walk over a function. What it finds makes more differ, so that it is walked again until nothing is new.
class DivergenceWalk {
 public:
  DivergenceWalk(Divergence& whole, FunctionId id, const Kernel& kernel)
      : whole_(whole),
        id_(id),
        function_(whole.module_.functions[id]),
        own_(whole.functions_.at(id)),
        order_(whole.module_, function_),
        declared_(function_.variables.size()) {
    if (own_.isCalledApart) frames_.push_back({Frame::Whole, nullptr});
    if (own_.returnsApart) frames_.push_back({Frame::Whole, nullptr});
    for (VarId i = 0; i < function_.variables.size(); ++i) {
      const bool isCallers = i < function_.parameterCount && function_.variables[i].role == VarRole::InOut;
      declared_[i] = {isCallers ? 0 : frames_.size(), 0, isCallers};
    }
    for (VarId i = 0; id == kernel.entry && i < kernel.params.size(); ++i) {
      const ParamRole role = kernel.params[i].role;
      if (role == ParamRole::Output) {
        differ(i);
        isOutput_.insert(i);
      }
      if (role == ParamRole::Input || role == ParamRole::Iterator) mark(i);
    }
  }

  /// Whether something was found.
  bool run() {
    block(function_.body);
    return isNew_;
  }

 private:
  /// Why some lanes wait.
  struct Frame {
    enum Kind : std::uint8_t { Whole, Branch, Exit, Skip } kind;
    const Stmt* loop;  ///< of Exit and Skip
  };
  struct Declared {
    std::size_t frames, loops;
    bool isCallers;
  };

  void set(bool& flag) {
    isNew_ = isNew_ || !flag;
    flag = true;
  }
  void insert(std::set<const Stmt*>& where, const Stmt& stmt) {
    if (where.insert(&stmt).second) isNew_ = true;
  }
  void differ(VarId var) {
    if (own_.variables[var]) return;
    own_.variables[var] = true;
    isNew_ = true;
  }
  void leaveStep(VarId var) {
    if (!whole_.outOfStep_[id_].insert(var).second) return;
    whole_.inStep_[id_].erase(var);
    isNew_ = true;
  }
  void mark(VarId var) {
    leaveStep(var);
    differ(var);
  }
  bool differs(const Expr& expr) const { return whole_.differs(id_, expr); }

  /// Whether a lane that waits might read what is assigned to a variable here. One that has left a loop does not, where
  /// the variable lives but in it.
  bool seenByOthers(VarId var) const {
    const Declared& declared = declared_[var];
    return std::any_of(frames_.begin() + static_cast<std::ptrdiff_t>(declared.frames), frames_.end(),
                       [&](const Frame& frame) {
                         if (frame.kind != Frame::Exit || declared.isCallers) return true;
                         return loops_[declared.loops] != frame.loop ||
                                order_.lastUse[var] > order_.ends.at(frame.loop);
                       });
  }

  /// The loop that some lanes have left where this variable is assigned to, while all that are in it go on in step; none where there
  /// is more to it.
  const Stmt* loopInStep(VarId var) const {
    const Declared& declared = declared_[var];
    const Type type = function_.variables[var].type;
    const bool isOwn = var >= function_.parameterCount || isOutput_.contains(var);
    if (!isOwn || !type.isScalar() || !type.isArithmetic() || frames_.size() != declared.frames + 1)
      return nullptr;
    const Frame& frame = frames_.back();
    if (frame.kind != Frame::Exit || loops_[declared.loops] != frame.loop) return nullptr;
    if (whole_.outOfStep_[id_].contains(var)) return nullptr;
    const bool isOfOther = whole_.isInStep(id_, var) && whole_.inStep_.at(id_).at(var).loop != frame.loop;
    return isOfOther ? nullptr : frame.loop;
  }
  void keepInStep(VarId var, const Stmt& stmt) {
    if (whole_.isInStep(id_, var)) return;
    const Loop& loop = std::get<Loop>(stmt.node);
    Divergence::InStep& own = whole_.inStep_[id_][var];
    own.loop = &stmt;
    const auto add = [&](const Expr& expr) {
      const auto* n = std::get_if<VarRef>(&expr.node);
      if (n != nullptr && n->var == var) own.reads.insert(&expr);
    };
    if (loop.cond) walkExprs(static_cast<const Expr&>(*loop.cond), add);
    walkExprs(loop.body, add);
    walkExprs(loop.step, add);
    isNew_ = true;
  }

  void assigned(const Stmt& stmt, const Expr& place, bool valueDiffers) {
    const VarId var = rootOf(place);
    bool indexDiffers = false;
    walkExprs(place, [&](const Expr& inner) {
      const auto* n = std::get_if<Index>(&inner.node);
      indexDiffers = indexDiffers || (n != nullptr && differs(*n->index));
    });
    const bool isSeen = seenByOthers(var);
    if (isSeen) insert(whole_.blended_, stmt);
    if (valueDiffers || indexDiffers) return mark(var);
    if (!isSeen) return;
    const Stmt* const loop = loopInStep(var);
    if (loop == nullptr) return mark(var);
    keepInStep(var, *loop);
    differ(var);
  }

  void block(const Block& statements) {
    for (const Stmt& stmt : statements) {
      forEachOperand(stmt, [&](const ExprPtr& operand) { calls(*operand, !frames_.empty()); });
      match(stmt.node, [&](const auto& node) { visit(stmt, node); });
    }
  }
  void within(Frame frame, const Block& statements) {
    frames_.push_back(frame);
    block(statements);
    frames_.pop_back();
  }

  /// What functions are called with, in an expression.
  void calls(const Expr& expr, bool isApart) {
    if (const auto* n = std::get_if<Call>(&expr.node)) {
      FunctionDivergence& callee = whole_.functions_.at(n->callee);
      for (std::size_t i = 0; i < n->args.size(); ++i) {
        if (differs(*n->args[i])) markArgument(callee, i);
      }
      if (isApart) set(callee.isCalledApart);
    }
    const Expr* condition = nullptr;
    if (const auto* n = std::get_if<Select>(&expr.node)) condition = n->cond.get();
    if (const auto* n = std::get_if<Binary>(&expr.node);
        n != nullptr && (n->op == BinaryOp::LogicalAnd || n->op == BinaryOp::LogicalOr))
      condition = n->lhs.get();
    const bool parts = condition != nullptr && differs(*condition);
    forEachOperand(expr, [&](const ExprPtr& operand) {
      calls(*operand, isApart || (parts && operand.get() != condition));
    });
  }
  void markArgument(FunctionDivergence& callee, std::size_t i) {
    if (callee.variables[i]) return;
    callee.variables[i] = true;
    isNew_ = true;
  }

  void visit(const Stmt&, const Declare& n) {
    declared_[n.var] = {frames_.size(), loops_.size(), false};
    if (!n.init) return;
    if (!order_.assigned.contains(n.var)) whole_.constant_[id_][n.var] = n.init.get();
    const Expr* init = n.init.get();
    std::vector<std::uint8_t> components = {0, 1, 2, 3};
    if (const auto* swizzle = std::get_if<Swizzle>(&init->node)) {
      components = swizzle->components;
      init = swizzle->base.get();
    }
    if (std::holds_alternative<IndexOf>(init->node) && n.init->type.isVector() &&
        !order_.assigned.contains(n.var)) {
      whole_.indices_[id_][n.var] = components;
    }
    if (differs(*n.init)) mark(n.var);
  }
  void visit(const Stmt& stmt, const Assign& n) { assigned(stmt, *n.place, differs(*n.value)); }
  void visit(const Stmt& stmt, const CallStmt& n) {
    FunctionDivergence& callee = whole_.functions_.at(n.callee);
    const Function& called = whole_.module_.functions[n.callee];
    bool argumentDiffers = false;
    for (std::size_t i = 0; i < n.args.size(); ++i) {
      const bool differ = differs(*n.args[i]);
      argumentDiffers = argumentDiffers || differ;
      if (called.variables[i].role == VarRole::InOut) {
        const VarId root = rootOf(*n.args[i]);
        leaveStep(root);
        if (callee.variables[i] || seenByOthers(root)) mark(root);
        if (own_.variables[root]) markArgument(callee, i);
      } else if (differ) {
        markArgument(callee, i);
      }
    }
    if (!frames_.empty()) set(callee.isCalledApart);
    if (n.result) leaveStep(rootOf(*n.result));
    if (n.result) assigned(stmt, *n.result, callee.result || argumentDiffers);
  }
  void visit(const Stmt& stmt, const If& n) {
    if (!differs(*n.cond)) {
      block(n.then);
      return block(n.otherwise);
    }
    insert(whole_.apart_, stmt);
    within({Frame::Branch, nullptr}, n.then);
    within({Frame::Branch, nullptr}, n.otherwise);
  }
  void visit(const Stmt& stmt, const Loop& n) {
    block(n.init);
    if (n.cond && differs(*n.cond)) insert(whole_.apart_, stmt);
    loops_.push_back(&stmt);
    entered_.push_back(frames_.size());
    const bool isApart = whole_.isApart(stmt);
    if (isApart) frames_.push_back({Frame::Exit, &stmt});
    if (n.cond) calls(*n.cond, !frames_.empty());
    if (whole_.skipsApart(stmt)) {
      within({Frame::Skip, &stmt}, n.body);
    } else {
      block(n.body);
    }
    block(n.step);
    if (isApart) frames_.pop_back();
    entered_.pop_back();
    loops_.pop_back();
  }
  void visit(const Stmt&, const Switch& n) {
    for (const Case& one : n.cases) block(one.body);  // what differs has no form for lanes
  }
  /// Whether some lanes that are in the innermost loop wait.
  bool isApartInLoop() const {
    return std::any_of(frames_.begin() + static_cast<std::ptrdiff_t>(entered_.back()), frames_.end(),
                       [](const Frame& frame) { return frame.kind != Frame::Exit; });
  }
  void visit(const Stmt& stmt, const Break&) {
    if (loops_.empty() || !isApartInLoop()) return;
    insert(whole_.apart_, stmt);
    insert(whole_.apart_, *loops_.back());
  }
  void visit(const Stmt& stmt, const Continue&) {
    if (!isApartInLoop()) return;
    insert(whole_.apart_, stmt);
    insert(whole_.skipped_, *loops_.back());
  }
  void visit(const Stmt& stmt, const Return& n) {
    if (n.value && differs(*n.value)) set(own_.result);
    const bool isApart =
        std::ranges::any_of(frames_, [](const Frame& frame) { return frame.kind != Frame::Whole; });
    if (!isApart) return;
    insert(whole_.apart_, stmt);
    set(own_.returnsApart);
    if (n.value) set(own_.result);
    for (const Stmt* loop : loops_) insert(whole_.apart_, *loop);
  }
  void visit(const Stmt&, const Scope& n) { block(n.body); }
  void visit(const Stmt&, const Push&) {}
  void visit(const Stmt&, const Scatter&) {}

  Divergence& whole_;
  FunctionId id_;
  const Function& function_;
  FunctionDivergence& own_;
  Order order_;
  std::vector<Declared> declared_;
  std::vector<Frame> frames_;
  std::vector<const Stmt*> loops_;
  std::vector<std::size_t> entered_;  ///< frames around each of the loops
  std::set<VarId> isOutput_;  ///< of the kernel, each of which begins as 0
  bool isNew_ = false;
};

Divergence::Divergence(const Module& module, const Kernel& kernel) : module_(module), kernel_(kernel) {
  const std::vector<FunctionId> functions = functionsOf(module, kernel);
  for (const FunctionId id : functions) {
    functions_[id].variables.assign(module.functions[id].variables.size(), false);
  }
  for (bool isNew = true; isNew;) {
    isNew = false;
    for (const FunctionId id : functions) {
      const bool found = DivergenceWalk(*this, id, kernel).run();
      isNew = isNew || found;
    }
  }
}

}  // namespace skc::emit
