// SPDX-License-Identifier: MIT
#include "transforms/fold_pattern.hpp"

#include <algorithm>

#include "ir/build.hpp"
#include "ir/walk.hpp"

namespace skc {
namespace {

using namespace ir;

constexpr VarId element = 0;
constexpr VarId accumulator = 1;

int countAccumulator(const Expr& expr) {
  int count = 0;
  walkExprs(expr, [&](const Expr& inner) {
    const auto* n = std::get_if<VarRef>(&inner.node);
    if (n != nullptr && n->var == accumulator) ++count;
  });
  return count;
}

/// A place made of members and at most one swizzle: all that is known before the program runs.
struct StaticPlace {
  std::vector<std::uint32_t> members;
  Type type;
  unsigned components = 0;
  bool operator==(const StaticPlace&) const = default;
};

/// Of `variable`; nothing for other expressions.
std::optional<StaticPlace> staticPlace(const Expr& expr, VarId variable) {
  StaticPlace place;
  const Expr* base = &expr;
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    for (std::uint8_t component : n->components) place.components |= 1U << component;
    base = n->base.get();
  }
  if (!base->type.isArithmetic()) return std::nullopt;
  place.type = base->type;
  if (place.components == 0) place.components = (1U << base->type.width) - 1;
  while (const auto* n = std::get_if<Member>(&base->node)) {
    place.members.insert(place.members.begin(), n->field);
    base = n->base.get();
  }
  const auto* root = std::get_if<VarRef>(&base->node);
  if (root == nullptr || root->var != variable) return std::nullopt;
  return place;
}

bool isCommutative(BinaryOp op) {
  constexpr BinaryOp all[] = {BinaryOp::Add,    BinaryOp::Mul,        BinaryOp::BitAnd,   BinaryOp::BitOr,
                              BinaryOp::BitXor, BinaryOp::LogicalAnd, BinaryOp::LogicalOr};
  return std::find(std::begin(all), std::end(all), op) != std::end(all);
}

bool isPlaceOf(VarId variable, const Expr& expr, const StaticPlace& place) {
  const std::optional<StaticPlace> other = staticPlace(expr, variable);
  return other && *other == place;
}

bool isSame(const Expr& expr, const StaticPlace& place) { return isPlaceOf(accumulator, expr, place); }

std::optional<FoldOp> minOrMax(Intrinsic intrinsic) {
  if (intrinsic == Intrinsic::Min || intrinsic == Intrinsic::Fmin) return Intrinsic::Min;
  if (intrinsic == Intrinsic::Max || intrinsic == Intrinsic::Fmax) return Intrinsic::Max;
  return std::nullopt;
}

/// The operator by which `value` is `place op f`, possibly a chain `place op f op g`.
std::optional<FoldOp> selfFold(const Expr& value, const StaticPlace& place) {
  if (const auto* n = std::get_if<Binary>(&value.node)) {
    if (isComparison(n->op)) return std::nullopt;
    if (n->lhs->type.isMatrix() || n->rhs->type.isMatrix()) return std::nullopt;   // its * has an order
    if (isSame(*n->lhs, place) || selfFold(*n->lhs, place) == FoldOp(n->op)) return n->op;
    if (isCommutative(n->op) && isSame(*n->rhs, place)) return n->op;
  }
  if (const auto* n = std::get_if<IntrinsicCall>(&value.node)) {
    const std::optional<FoldOp> op = minOrMax(n->intrinsic);
    if (op && (isSame(*n->args[0], place) || isSame(*n->args[1], place))) return op;
  }
  return std::nullopt;
}

/// A statement that folds into the accumulator.
std::optional<FoldPart> foldOf(const Stmt& stmt) {
  const auto* n = std::get_if<Assign>(&stmt.node);
  if (n == nullptr) return std::nullopt;
  const std::optional<StaticPlace> place = staticPlace(*n->place, accumulator);
  if (!place) return std::nullopt;
  const std::optional<FoldOp> op = n->op ? FoldOp(*n->op) : selfFold(*n->value, *place);
  if (!op) return std::nullopt;
  const int reads = n->op ? 0 : 1;
  if (countAccumulator(*n->value) != reads) return std::nullopt;
  return FoldPart{place->members, place->type, place->components, *op, stmt.loc};
}

/// Adds a part; false where one of its components is folded by another operator already.
bool add(std::vector<FoldPart>& parts, FoldPart part) {
  for (FoldPart& other : parts) {
    if (other.members != part.members) continue;
    if (other.op == part.op) {
      other.components |= part.components;
      return true;
    }
    if ((other.components & part.components) != 0) return false;
  }
  parts.push_back(std::move(part));
  return true;
}

/// `place op= element`, in any of the forms, with the same place in the element.
bool isPlain(const Stmt& stmt) {
  const auto* n = std::get_if<Assign>(&stmt.node);
  if (n == nullptr) return false;
  const std::optional<StaticPlace> place = staticPlace(*n->place, accumulator);
  const auto isElement = [&](const Expr& expr) { return isPlaceOf(element, expr, *place); };
  if (!place) return false;
  if (n->op) return isElement(*n->value);
  if (const auto* b = std::get_if<Binary>(&n->value->node)) return isElement(*b->lhs) || isElement(*b->rhs);
  const auto* c = std::get_if<IntrinsicCall>(&n->value->node);
  return c != nullptr &&
         std::any_of(c->args.begin(), c->args.end(), [&](const ExprPtr& arg) { return isElement(*arg); });
}

}  // namespace

std::optional<FoldPattern> recogniseFold(const Function& entry) {
  FoldPattern pattern{{}, false};
  bool matches = true;
  walkStmts(entry.body, [&](const Stmt& stmt) {
    std::optional<FoldPart> part = foldOf(stmt);
    if (part) {
      matches = matches && add(pattern.parts, std::move(*part));
      return;
    }
    forEachOperand(stmt,
                   [&](const ExprPtr& operand) { matches = matches && countAccumulator(*operand) == 0; });
  });
  if (!matches || pattern.parts.empty()) return std::nullopt;
  pattern.isPlain = entry.variables[element].type == entry.variables[accumulator].type &&
                    std::all_of(entry.body.begin(), entry.body.end(), isPlain);
  return pattern;
}

}  // namespace skc
