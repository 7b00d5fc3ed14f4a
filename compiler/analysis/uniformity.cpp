// SPDX-License-Identifier: MIT
#include "analysis/uniformity.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include "ir/build.hpp"
#include "ir/call_graph.hpp"
#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::analysis {

using namespace ir;

namespace {

/// Replaces missing shapes: a leaf that nothing is assigned to is uniform.
std::vector<Shape> known(const LeafShapes& leaves) {
  std::vector<Shape> shapes;
  for (const LeafShape leaf : leaves) shapes.push_back(leaf.value_or(Shape::Uniform));
  return shapes;
}

void makeUniform(LeafShapes& leaves) {
  for (LeafShape& leaf : leaves) leaf = leaf.value_or(Shape::Uniform);
}

/// The shapes of the entry's variables at its start.
LeafShape atEntry(const Kernel& kernel, VarId var, Axis axis) {
  // predicate's mask: true in the lanes that have an element, the same in all rows
  if (var >= kernel.params.size()) return axis == Axis::X ? Shape::Varying : Shape::Uniform;
  switch (kernel.params[var].role) {
    case ParamRole::Input:
    case ParamRole::Iterator:
    case ParamRole::Accumulator: return Shape::Varying;
    case ParamRole::Output: return std::nullopt;
    case ParamRole::Uniform:
    case ParamRole::Gather:
    case ParamRole::VariableOutput:
    case ParamRole::Scatter:
    case ParamRole::Spec: break;
  }
  return Shape::Uniform;
}

}  // namespace

Uniformity::Uniformity(const Module& module, const Kernel& kernel, Axis axis)
    : module_(module), kernel_(kernel), axis_(axis) {
  const std::vector<FunctionId> functions = functionsOf(module, kernel);
  for (const FunctionId id : functions) {
    const Function& function = module.functions[id];
    FunctionShapes& own = shapes_[id];
    for (VarId i = 0; i < function.variables.size(); ++i) {
      const bool isParameter = id == kernel.entry && i < function.parameterCount;
      own.variables.emplace_back(leafCount(module, function.variables[i].type),
                                 isParameter ? atEntry(kernel, i, axis) : std::nullopt);
    }
    own.result.resize(leafCount(module, function.result));
    facts_[id] = {};
  }
  propagate(functions);
  // Variables that are never assigned still have no shape, nor have values computed from them alone.
  for (auto& [id, own] : shapes_) {
    for (LeafShapes& leaves : own.variables) makeUniform(leaves);
    makeUniform(own.result);
  }
  propagate(functions);
  for (const auto& [id, own] : shapes_) {
    for (const LeafShapes& leaves : own.variables) facts_[id].variables.push_back(known(leaves));
    facts_[id].result = known(own.result);
  }
}

void Uniformity::propagate(const std::vector<FunctionId>& functions) {
  // results flow from callees to callers, arguments the other way: each round goes both ways
  bool isNew = true;
  const auto walk = [&](FunctionId id) { isNew = DivergenceWalk(*this, id).run() || isNew; };
  while (std::exchange(isNew, false)) {
    std::ranges::for_each(functions, walk);
    if (isNew) std::ranges::for_each(std::views::reverse(functions), walk);
  }
}

std::span<const Shape> Uniformity::of(FunctionId function, VarId var) const {
  return at(function).variables[var];
}

std::span<const Shape> Uniformity::resultOf(FunctionId function) const { return at(function).result; }

std::vector<Shape> Uniformity::leavesOf(FunctionId function, const Expr& expr) const {
  return known(ExprShapes(module_, kernel_, shapes_, axis_).of(function, expr));
}

Shape Uniformity::of(FunctionId function, const Expr& expr) const {
  const LeafShape all = join(ExprShapes(module_, kernel_, shapes_, axis_).of(function, expr));
  const bool isPart = all == Shape::Consecutive && !expr.type.isScalar();
  return isPart ? Shape::Varying : all.value_or(Shape::Uniform);
}

bool Uniformity::diverges(FunctionId function, const Stmt& stmt) const {
  return at(function).divergent.contains(&stmt);
}

bool Uniformity::skips(FunctionId function, const Stmt& loop) const {
  return at(function).skipping.contains(&loop);
}

bool Uniformity::blends(FunctionId function, const Stmt& stmt, VarId var) const {
  return at(function).blended.contains({&stmt, var});
}

LastUses::LastUses(const Function& function) : lastUse_(function.variables.size(), 0) {
  visit(function.body);
}

void LastUses::visit(const Block& block) {
  for (const Stmt& stmt : block) {
    ++now_;
    forEachOperand(stmt, [&](const ExprPtr& operand) { use(*operand); });
    forEachBlock(stmt, [&](const Block& inner) { visit(inner); });
    const auto* loop = std::get_if<Loop>(&stmt.node);
    if (loop == nullptr) continue;
    if (loop->cond) use(*loop->cond);  // evaluated after the body in a `do` loop
    ends_[&stmt] = now_;
  }
}

void LastUses::use(const Expr& expr) {
  walkExprs(expr, [&](const Expr& inner) {
    if (const auto* n = std::get_if<VarRef>(&inner.node)) lastUse_[n->var] = now_;
  });
}

DivergenceWalk::DivergenceWalk(Uniformity& uniformity, FunctionId id)
    : uniformity_(uniformity),
      id_(id),
      function_(uniformity.module_.functions[id]),
      facts_(uniformity.facts_.at(id)),
      exprs_(uniformity.module_, uniformity.kernel_, uniformity.shapes_, uniformity.axis_),
      lastUses_(function_),
      declared_(function_.variables.size()) {
  for (VarId i = 0; i < function_.parameterCount; ++i) {
    declared_[i] = {0, 0, function_.variables[i].role == VarRole::InOut};
  }
}

bool DivergenceWalk::run() {
  block(function_.body, Frame::Function);
  return isNew_;
}

// ---- recording facts ----------------------------------------------------------------------------

void DivergenceWalk::set(bool& flag) {
  isNew_ = isNew_ || !flag;
  flag = true;
}

void DivergenceWalk::insert(std::set<const Stmt*>& where, const Stmt& stmt) {
  if (where.insert(&stmt).second) isNew_ = true;
}

void DivergenceWalk::add(LeafShapes& into, const LeafShapes& from) {
  for (std::size_t i = 0; i < into.size(); ++i) {
    const LeafShape joined = join(into[i], from[i]);
    if (joined == into[i]) continue;
    into[i] = joined;
    isNew_ = true;
  }
}

// ---- statements ---------------------------------------------------------------------------------

/// From the first statement on that lets some lanes leave this body (`leaves`), these lanes are inactive.
void DivergenceWalk::block(const Block& statements, Frame::Kind leaves) {
  const std::size_t frames = frames_.size();
  for (const Stmt& stmt : statements) {
    const bool isFirst = leaves != Frame::Branch && frames_.size() == frames && jumps(stmt, leaves);
    if (isFirst) frames_.push_back({leaves, loops_.empty() ? 0 : loops_.size() - 1});
    forEachOperand(stmt, [&](const ExprPtr& operand) {
      if (!std::holds_alternative<Loop>(stmt.node)) calls(*operand);
    });
    match(stmt.node, [&](const auto& node) { visit(stmt, node); });
  }
  frames_.resize(frames);
}

/// True if the statement contains a divergent jump out of the function, or out of this iteration of its loop.
bool DivergenceWalk::jumps(const Stmt& stmt, Frame::Kind left) const {
  const bool isJump = left == Frame::Function ? std::holds_alternative<Return>(stmt.node)
                                              : std::holds_alternative<Continue>(stmt.node);
  if (isJump) return facts_.divergent.contains(&stmt);
  if (left == Frame::Iteration && std::holds_alternative<Loop>(stmt.node)) return false;
  bool found = false;
  forEachBlock(stmt, [&](const Block& inner) {
    found = found || std::ranges::any_of(inner, [&](const Stmt& one) { return jumps(one, left); });
  });
  return found;
}

void DivergenceWalk::calls(const Expr& expr) {
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<Call>(&inner.node);
    if (n == nullptr) return;
    FunctionShapes& callee = uniformity_.shapes_.at(n->callee);
    for (std::size_t i = 0; i < n->args.size(); ++i) add(callee.variables[i], shapes(*n->args[i]));
    called(n->callee);
  });
}

void DivergenceWalk::called(FunctionId callee) {
  if (!frames_.empty()) set(uniformity_.facts_.at(callee).isCalledDivergently);
}

void DivergenceWalk::visit(const Stmt&, const Declare& n) {
  declared_[n.var] = {frames_.size(), loops_.size(), false};
  if (n.init) add(uniformity_.shapes_.at(id_).variables[n.var], shapes(*n.init));
}

void DivergenceWalk::visit(const Stmt& stmt, const Assign& n) {
  assign(stmt, *n.place, n.op ? exprs_.ofCompound(id_, *n.place, *n.op, *n.value) : shapes(*n.value));
}

void DivergenceWalk::visit(const Stmt& stmt, const CallStmt& n) {
  FunctionShapes& callee = uniformity_.shapes_.at(n.callee);
  const std::vector<Variable>& parameters = uniformity_.module_.functions[n.callee].variables;
  for (std::size_t i = 0; i < n.args.size(); ++i) {
    const VarRole role = parameters[i].role;
    if (role != VarRole::Gather && role != VarRole::AppendOutput)
      add(callee.variables[i], shapes(*n.args[i]));
  }
  called(n.callee);
  for (std::size_t i = 0; i < n.args.size(); ++i) {
    if (parameters[i].role == VarRole::InOut) assign(stmt, *n.args[i], callee.variables[i]);
  }
  if (n.result) assign(stmt, *n.result, callee.result);
}

void DivergenceWalk::assign(const Stmt& stmt, const Expr& place, LeafShapes value) {
  const VarId var = rootOf(place);
  if (isVisibleToInactiveLanes(var)) {
    if (facts_.blended.insert({&stmt, var}).second) isNew_ = true;
    std::ranges::fill(value, LeafShape(Shape::Varying));
  }
  add(uniformity_.shapes_.at(id_).variables[var], exprs_.assigned(id_, place, std::move(value)));
}

void DivergenceWalk::visit(const Stmt& stmt, const If& n) {
  const bool diverges = isVarying(join(shapes(*n.cond)));
  if (diverges) {
    insert(facts_.divergent, stmt);
    frames_.push_back({Frame::Branch});
  }
  block(n.then);
  block(n.otherwise);
  if (diverges) frames_.pop_back();
}

void DivergenceWalk::visit(const Stmt& stmt, const Loop& n) {
  block(n.init);
  if (n.cond && isVarying(join(shapes(*n.cond)))) insert(facts_.divergent, stmt);
  enclosing_.push_back({&stmt, frames_.size(), true});
  if (facts_.divergent.contains(&stmt)) frames_.push_back({Frame::Loop, loops_.size()});
  loops_.push_back(&stmt);
  if (n.cond) calls(*n.cond);
  block(n.body, Frame::Iteration);
  block(n.step);
  loops_.pop_back();
  frames_.resize(enclosing_.back().frames);
  enclosing_.pop_back();
}

/// Each case of a divergent switch activates more lanes, which were inactive in the cases before it.
void DivergenceWalk::visit(const Stmt& stmt, const Switch& n) {
  if (isVarying(join(shapes(*n.value)))) insert(facts_.divergent, stmt);
  enclosing_.push_back({&stmt, frames_.size(), false});
  if (facts_.divergent.contains(&stmt)) frames_.push_back({Frame::Branch});
  for (const Case& one : n.cases) block(one.body);
  frames_.resize(enclosing_.back().frames);
  enclosing_.pop_back();
}

/// True if lanes are inactive for any other reason than having left what this jump leaves.
bool DivergenceWalk::isDivergentJump(std::size_t frames, Frame::Kind allowed) const {
  return std::any_of(frames_.begin() + static_cast<std::ptrdiff_t>(frames), frames_.end(),
                     [&](const Frame& frame) { return frame.kind != allowed; });
}

void DivergenceWalk::visit(const Stmt& stmt, const Break&) {
  const Enclosing& left = enclosing_.back();
  if (!isDivergentJump(left.frames, Frame::Loop)) return;
  insert(facts_.divergent, stmt);
  insert(facts_.divergent, *left.stmt);
}

/// A switch that some lanes leave runs under a mask, so that these lanes skip its remaining cases.
void DivergenceWalk::visit(const Stmt& stmt, const Continue&) {
  const auto loop = std::find_if(enclosing_.rbegin(), enclosing_.rend(),
                                 [](const Enclosing& enclosing) { return enclosing.isLoop; });
  if (!isDivergentJump(loop->frames, Frame::Loop)) return;
  insert(facts_.divergent, stmt);
  insert(facts_.skipping, *loop->stmt);
  for (auto left = enclosing_.rbegin(); left != loop; ++left) insert(facts_.divergent, *left->stmt);
}

void DivergenceWalk::visit(const Stmt& stmt, const Return& n) {
  if (n.value) add(uniformity_.shapes_.at(id_).result, shapes(*n.value));
  if (!isDivergentJump(0, Frame::Function)) return;
  insert(facts_.divergent, stmt);
  set(facts_.returnsEarly);
  LeafShapes& result = uniformity_.shapes_.at(id_).result;
  add(result, LeafShapes(result.size(), Shape::Varying));
  for (const Enclosing& left : enclosing_) insert(facts_.divergent, *left.stmt);
}

void DivergenceWalk::visit(const Stmt&, const Scope& n) { block(n.body); }

// ---- visibility to inactive lanes ----------------------------------------------------------------

bool DivergenceWalk::isVisibleToInactiveLanes(VarId var) const {
  const Declared& declared = declared_[var];
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    const bool isInside = frames_[i].kind == Frame::Branch && declared.frames > i;
    if (!isInside && isVisibleOutside(frames_[i], declared, var)) return true;
  }
  return false;
}

/// True if lanes that are inactive because of this frame may read the variable before it is declared again.
bool DivergenceWalk::isVisibleOutside(const Frame& frame, const Declared& declared, VarId var) const {
  switch (frame.kind) {
    case Frame::Branch: return true;
    case Frame::Function: return declared.isReadByCaller;
    case Frame::Iteration: return declared.loops <= frame.loop;
    case Frame::Loop: break;
  }
  if (declared.loops > frame.loop) return false;
  return declared.isReadByCaller || declared.loops < frame.loop ||
         lastUses_.isUsedAfter(var, *loops_[frame.loop]);
}

}  // namespace skc::analysis
