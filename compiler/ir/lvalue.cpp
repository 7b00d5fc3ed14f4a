// SPDX-License-Identifier: MIT
#include "ir/lvalue.hpp"

#include <algorithm>
#include <variant>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc::ir {
namespace {

/// One step from a variable towards a part of it.
struct Step {
  enum class Kind : std::uint8_t { Field, Element, AnyElement, Components };
  Kind kind;
  std::uint32_t value = 0;  ///< the field, the element, or a bit for each component
};

/// The element that a literal index names: the nearest one.
std::uint32_t nearestElement(const Expr& index, std::uint32_t bits, std::uint32_t length) {
  if (index.type.arithmeticType().scalar == Scalar::Int && static_cast<std::int32_t>(bits) < 0) return 0;
  return std::min(bits, length - 1);
}

Step stepOf(const Module& module, const Index& n) {
  const Type base = n.base->type;
  const auto* literal = std::get_if<Literal>(&n.index->node);
  if (literal == nullptr) return {base.isVector() ? Step::Kind::Components : Step::Kind::AnyElement, ~0U};
  const std::uint32_t length =
      base.kind == Type::Kind::Array ? module.arrays[base.index].length : std::uint32_t{base.width};
  const std::uint32_t element = nearestElement(*n.index, literal->bits, length);
  if (base.isVector()) return {Step::Kind::Components, 1U << element};
  return {Step::Kind::Element, element};
}

/// The steps from the root of an lvalue to what it names. Components end them.
std::vector<Step> stepsOf(const Module& module, const Expr& lvalue) {
  std::vector<Step> steps;   // in reverse
  const Expr* e = &lvalue;
  while (!std::holds_alternative<VarRef>(e->node)) {
    if (const auto* member = std::get_if<Member>(&e->node)) {
      steps.push_back({Step::Kind::Field, member->field});
      e = member->base.get();
    } else if (const auto* index = std::get_if<Index>(&e->node)) {
      const Step step = stepOf(module, *index);
      if (step.kind == Step::Kind::Components) steps.clear();
      steps.push_back(step);
      e = index->base.get();
    } else {
      const auto& swizzle = std::get<Swizzle>(e->node);
      std::uint32_t components = 0;
      for (const std::uint8_t component : swizzle.components) components |= 1U << component;
      steps.clear();
      steps.push_back({Step::Kind::Components, components});
      e = swizzle.base.get();
    }
  }
  std::ranges::reverse(steps);
  return steps;
}

bool areDisjoint(const std::vector<Step>& a, const std::vector<Step>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const bool anyElement = a[i].kind == Step::Kind::AnyElement || b[i].kind == Step::Kind::AnyElement;
    if (anyElement) return false;
    if (a[i].kind == Step::Kind::Components) return (a[i].value & b[i].value) == 0;
    if (a[i].value != b[i].value) return true;
  }
  return false;
}

/// Follows a function's statements in order, and notes which parts of one parameter have been written.
class AliasSearch {
 public:
  AliasSearch(const Module& module, const Function& function, VarId read, VarId written, bool sameObject)
      : module_(module), function_(function), read_(read), written_(written), sameObject_(sameObject) {}

  bool run() {
    block(function_.body);
    return found_;
  }

 private:
  void block(const Block& block) {
    for (const Stmt& stmt : block) statement(stmt);
  }

  void statement(const Stmt& stmt) {
    const auto* call = std::get_if<CallStmt>(&stmt.node);
    // within the callee, reads may follow writes
    if (call != nullptr) noteWrites(stmt);
    forEachOperand(stmt, [&](const ExprPtr& e) { reads(*e); });
    if (call == nullptr) noteWrites(stmt);
    if (std::holds_alternative<Loop>(stmt.node) && !isInLoop_) return loop(stmt);
    forEachBlock(stmt, [&](const Block& inner) { block(inner); });
  }

  /// Every iteration follows others: all writes of the loop come before all of its reads.
  void loop(const Stmt& stmt) {
    isInLoop_ = true;
    forEachBlock(
        stmt, [&](const Block& inner) { walkStmts(inner, [&](const Stmt& within) { noteWrites(within); }); });
    forEachOperand(stmt, [&](const ExprPtr& e) { reads(*e); });
    forEachBlock(stmt, [&](const Block& inner) { block(inner); });
    isInLoop_ = false;
  }

  void noteWrites(const Stmt& stmt) {
    if (const auto* n = std::get_if<Assign>(&stmt.node)) write(*n->place);
    const auto* call = std::get_if<CallStmt>(&stmt.node);
    if (call == nullptr) return;
    const Function& callee = module_.functions[call->callee];
    for (std::size_t i = 0; i < call->args.size(); ++i) {
      if (callee.variables[i].role == VarRole::InOut) write(*call->args[i]);
    }
    if (call->result) write(*call->result);
  }

  void write(const Expr& lvalue) {
    if (rootOf(lvalue) == written_) writes_.push_back(stepsOf(module_, lvalue));
  }

  void reads(const Expr& expr) {
    if (isLValue(expr)) {
      if (rootOf(expr) == read_) readPart(stepsOf(module_, expr));
      return indices(expr);
    }
    forEachOperand(expr, [&](const ExprPtr& e) { reads(*e); });
  }

  void indices(const Expr& lvalue) {
    if (const auto* index = std::get_if<Index>(&lvalue.node)) reads(*index->index);
    forEachOperand(lvalue, [&](const ExprPtr& e) {
      if (isLValue(*e)) indices(*e);
    });
  }

  void readPart(const std::vector<Step>& part) {
    found_ = found_ || std::ranges::any_of(writes_, [&](const std::vector<Step>& write) {
               return !sameObject_ || !areDisjoint(part, write);
             });
  }

  const Module& module_;
  const Function& function_;
  VarId read_, written_;
  bool sameObject_, found_ = false, isInLoop_ = false;
  std::vector<std::vector<Step>> writes_;
};

}  // namespace

bool isLValue(const Expr& expr) {
  if (std::holds_alternative<VarRef>(expr.node)) return true;
  if (const auto* swizzle = std::get_if<Swizzle>(&expr.node)) return isLValue(*swizzle->base);
  if (const auto* member = std::get_if<Member>(&expr.node)) return isLValue(*member->base);
  if (const auto* index = std::get_if<Index>(&expr.node)) return isLValue(*index->base);
  return false;
}

bool isAssignable(const Variable& variable) {
  const bool isCopy = variable.role == VarRole::Local || variable.role == VarRole::In;
  return variable.role == VarRole::InOut || (isCopy && !variable.isConst);
}

bool areDisjoint(const Module& module, const Expr& a, const Expr& b) {
  return rootOf(a) != rootOf(b) || areDisjoint(stepsOf(module, a), stepsOf(module, b));
}

bool readsAny(const Expr& expr, const std::vector<VarId>& variables) {
  bool found = false;
  walkExprs(expr, [&](const Expr& e) {
    const auto* reference = std::get_if<VarRef>(&e.node);
    found = found || (reference != nullptr && std::ranges::binary_search(variables, reference->var));
  });
  return found;
}

bool hasIndexOf(const Expr& lvalue, const std::vector<VarId>& variables) {
  if (const auto* index = std::get_if<Index>(&lvalue.node)) {
    return readsAny(*index->index, variables) || hasIndexOf(*index->base, variables);
  }
  if (const auto* member = std::get_if<Member>(&lvalue.node)) return hasIndexOf(*member->base, variables);
  if (const auto* swizzle = std::get_if<Swizzle>(&lvalue.node)) return hasIndexOf(*swizzle->base, variables);
  return false;
}

bool readsAfterWriting(const Module& module, const Function& function, VarId read, VarId written,
                       bool sameObject) {
  return AliasSearch(module, function, read, written, sameObject).run();
}

unsigned StaticLValue::mask() const {
  unsigned mask = 0;
  for (const std::uint8_t component : components) mask |= 1U << component;
  return mask;
}

std::optional<StaticLValue> staticLValue(const Expr& expr) {
  StaticLValue lvalue{};
  const Expr* base = &expr;
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    lvalue.components = n->components;
    base = n->base.get();
  } else {
    for (std::uint8_t i = 0; i < expr.type.width; ++i) lvalue.components.push_back(i);
  }
  lvalue.type = base->type;
  while (const auto* n = std::get_if<Member>(&base->node)) {
    lvalue.members.insert(lvalue.members.begin(), n->field);
    base = n->base.get();
  }
  const auto* root = std::get_if<VarRef>(&base->node);
  if (root == nullptr) return std::nullopt;
  lvalue.root = root->var;
  return lvalue;
}

void forEachAssigned(const Module& module, const Stmt& stmt, FunctionRef<void(VarId)> fn) {
  if (const auto* n = std::get_if<Assign>(&stmt.node)) fn(rootOf(*n->place));
  const auto* call = std::get_if<CallStmt>(&stmt.node);
  if (call == nullptr) return;
  if (call->result) fn(rootOf(*call->result));
  const Function& callee = module.functions[call->callee];
  for (std::size_t i = 0; i < call->args.size(); ++i) {
    if (callee.variables[i].role == VarRole::InOut) fn(rootOf(*call->args[i]));
  }
}

namespace {

/// Calls fn for each variable that the block changes, perhaps more than once.
void forEachAssigned(const Module& module, const Block& block, FunctionRef<void(VarId)> fn) {
  walkStmts(block, [&](const Stmt& stmt) { forEachAssigned(module, stmt, fn); });
}

}  // namespace

bool assigns(const Module& module, const Block& block, VarId var) {
  bool found = false;
  forEachAssigned(module, block, [&](VarId assigned) { found = found || assigned == var; });
  return found;
}

std::vector<VarId> assignedIn(const Module& module, const Block& block) {
  std::vector<VarId> variables;
  forEachAssigned(module, block, [&](VarId var) { variables.push_back(var); });
  std::ranges::sort(variables);
  const auto repeated = std::ranges::unique(variables);
  variables.erase(repeated.begin(), repeated.end());
  return variables;
}

std::vector<bool> assignedVariables(const Module& module, const Function& function) {
  std::vector<bool> assigned(function.variables.size(), false);
  forEachAssigned(module, function.body, [&](VarId var) { assigned[var] = true; });
  return assigned;
}

}  // namespace skc::ir
