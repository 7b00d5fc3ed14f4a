// SPDX-License-Identifier: MIT
#include "analysis/index_expressions.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>

#include "analysis/shapes.hpp"
#include "support/overloaded.hpp"

namespace skc::analysis {

using namespace ir;

namespace {

std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

IndexValue unknown(std::uint8_t depends) { return {true, depends}; }

std::uint8_t dependsOf(const IndexValues& values) {
  std::uint8_t depends = OnNothing;
  for (const IndexValue& value : values) depends |= value.depends;
  return depends;
}

/// A scalar is broadcast to all components.
const IndexValue& component(const IndexValues& values, std::size_t i) {
  return values.size() == 1 ? values.front() : values[i];
}

/// A value of this type. A uint's range ends where it might have wrapped around.
IndexValue typed(Type type, IndexValue value) {
  if (!type.isInteger()) return unknown(value.depends);
  if (type.scalar == Scalar::Uint && value.range) {
    const Upper& negatedLow = value.range->value.negatedLow;
    const bool isNatural =
        negatedLow && negatedLow->perSpec == Distance().perSpec && negatedLow->constant <= 0;
    if (!isNatural) value.range = rangeOf(atLeast(0));
  }
  return value;
}

std::optional<IndexRange> arithmetic(BinaryOp op, const IndexRange& a, const IndexRange& b) {
  switch (op) {
    case BinaryOp::Add: return sum(a, b);
    case BinaryOp::Sub: return difference(a, b);
    case BinaryOp::Mul: return product(a, b);
    case BinaryOp::Div: return quotient(a, b);
    case BinaryOp::Rem: return remainder(a, b);
    case BinaryOp::BitAnd: return bitAnd(a, b);
    case BinaryOp::ShiftLeft: {
      const std::optional<std::int64_t> by = constantOf(b.value);
      return by && *by >= 0 && *by < 31 ? product(a, rangeOf(exactly(std::int64_t{1} << *by))) : IndexRange();
    }
    case BinaryOp::BitOr:
    case BinaryOp::BitXor:
    case BinaryOp::ShiftRight:
    case BinaryOp::Less:
    case BinaryOp::LessEqual:
    case BinaryOp::Greater:
    case BinaryOp::GreaterEqual:
    case BinaryOp::Equal:
    case BinaryOp::NotEqual:
    case BinaryOp::LogicalAnd:
    case BinaryOp::LogicalOr: return std::nullopt;
  }
  return std::nullopt;
}

IndexRange known(const IndexValue& value) { return value.range.value_or(IndexRange()); }

IndexValue combined(Type type, BinaryOp op, const IndexValue& a, const IndexValue& b) {
  if (!a.isSet || !b.isSet) return {};
  IndexValue result = unknown(a.depends | b.depends);
  if (type.isInteger()) result.range = arithmetic(op, known(a), known(b));
  return typed(type, result);
}

}  // namespace

/// One rule for each kind of expression.
class IndexRule {
 public:
  explicit IndexRule(const IndexExpressions& in) : in_(in) {}

  IndexValues of(const Expr& expr) const {
    return match(expr.node, [&](const auto& node) { return rule(expr.type, node); });
  }

 private:
  IndexValues all(Type type, const IndexValue& value) const {
    return IndexValues(leafCount(in_.module_, type), value);
  }

  IndexValues rule(Type type, const Literal& n) const {
    IndexValue value = unknown(OnNothing);
    if (type.isInteger()) {
      const bool isSigned = type.scalar == Scalar::Int;
      value.range =
          rangeOf(exactly(isSigned ? std::int64_t{static_cast<std::int32_t>(n.bits)} : std::int64_t{n.bits}));
    }
    return {value};
  }
  IndexValues rule(Type, const ConstantRef& n) const { return of(*in_.module_.constants[n.constant].value); }
  IndexValues rule(Type type, const VarRef& n) const {
    const IndexValues& values = in_.state_.variables[n.var];
    return values.empty() ? all(type, unknown(OnData)) : values;
  }
  IndexValues rule(Type type, const Unary& n) const {
    IndexValues values = of(*n.operand);
    for (IndexValue& value : values) {
      IndexValue zero = unknown(OnNothing);
      zero.range = rangeOf(exactly(0));
      value = n.op == UnaryOp::Negate ? combined(type, BinaryOp::Sub, zero, value) : unknown(value.depends);
    }
    return values;
  }
  IndexValues rule(Type type, const Binary& n) const {
    return in_.binary(n.op, type, of(*n.lhs), of(*n.rhs));
  }

  /// Each side is evaluated knowing the condition.
  IndexValues rule(Type, const Select& n) const {
    const IndexValues cond = of(*n.cond);
    IndexState states[] = {in_.state_, in_.state_};
    IndexValues sides[2];
    for (const bool isTrue : {false, true}) {
      IndexExpressions side(in_.module_, in_.kernel_, states[isTrue ? 1 : 0], in_.records_, in_.call_);
      if (cond.size() == 1) side.learn(*n.cond, isTrue);
      sides[isTrue ? 1 : 0] = side.of(isTrue ? *n.yes : *n.no);
    }
    for (std::size_t i = 0; i < sides[0].size(); ++i)
      sides[0][i] = joined(states[0].element, sides[0][i], states[1].element, sides[1][i]);
    return sides[0];
  }
  IndexValues rule(Type type, const Convert& n) const {
    IndexValues values = of(*n.operand);
    const Type from = n.operand->type;
    for (IndexValue& value : values) {
      if (from.isBool()) value.range = rangeOf(between(0, 1));
      if (!from.isInteger() && !from.isBool()) value.range.reset();
      // A large uint is a negative int.
      if (from.isInteger() && from.scalar == Scalar::Uint && value.range && !value.range->value.high)
        value.range.reset();
      value = typed(type, value);
    }
    return values;
  }
  IndexValues rule(Type type, const Construct& n) const {
    if (type.kind == Type::Kind::Array) {
      IndexValues result = of(*n.args.front());
      for (std::size_t a = 1; a < n.args.size(); ++a) {
        const IndexValues next = of(*n.args[a]);
        for (std::size_t i = 0; i < result.size(); ++i)
          result[i] = joined(in_.state_.element, result[i], in_.state_.element, next[i]);
      }
      return result;
    }
    IndexValues result;
    for (const ExprPtr& arg : n.args) std::ranges::copy(of(*arg), std::back_inserter(result));
    const bool isSplat = type.isVector() && result.size() == 1;
    return isSplat ? all(type, IndexValue(result.front())) : result;
  }
  IndexValues rule(Type, const Swizzle& n) const {
    const IndexValues base = of(*n.base);
    IndexValues result;
    for (const std::uint8_t component : n.components) result.push_back(base[component]);
    return result;
  }
  IndexValues rule(Type type, const Member& n) const {
    const IndexValues base = of(*n.base);
    const auto first = base.begin() + offset(firstLeaf(in_.module_, n.base->type, n.field));
    return IndexValues(first, first + offset(leafCount(in_.module_, type)));
  }
  IndexValues rule(Type type, const ir::Index& n) const {
    const IndexValues index = of(*n.index);
    const IndexValues base = of(*n.base);
    const std::size_t size = leafCount(in_.module_, type);
    IndexValues result(size);
    if (const auto number = n.base->type.kind == Type::Kind::Array
                                ? std::nullopt
                                : literalIndex(*n.index, n.base->type.width)) {
      std::copy_n(base.begin() + offset(*number * size), size, result.begin());
      return result;
    }
    for (std::size_t i = 0; i < base.size(); ++i) {
      IndexValue& into = result[i % size];
      into = joined(in_.state_.element, into, in_.state_.element, base[i]);
    }
    for (IndexValue& value : result) value.depends |= dependsOf(index);
    return result;
  }
  IndexValues rule(Type, const Call& n) const {
    std::vector<IndexValues> arguments;
    for (const ExprPtr& arg : n.args) arguments.push_back(of(*arg));
    return in_.call_(n.callee, arguments);
  }
  IndexValues rule(Type type, const IntrinsicCall& n) const {
    std::vector<IndexValues> args;
    std::uint8_t depends = OnNothing;
    for (const ExprPtr& arg : n.args) depends |= dependsOf(args.emplace_back(of(*arg)));
    IndexValues result = all(type, unknown(depends));
    if (!type.isInteger()) return result;
    for (std::size_t i = 0; i < result.size(); ++i) {
      const auto range = [&](std::size_t a) {
        return seenFrom(in_.state_.element, known(component(args[a], i)));
      };
      if (n.intrinsic == Intrinsic::Min) result[i].range = smaller(range(0), range(1));
      if (n.intrinsic == Intrinsic::Max) result[i].range = larger(range(0), range(1));
      if (n.intrinsic == Intrinsic::Clamp) result[i].range = smaller(larger(range(0), range(1)), range(2));
      if (n.intrinsic == Intrinsic::Abs)
        result[i].range = larger(range(0), difference(rangeOf(exactly(0)), range(0)));
      result[i] = typed(type, result[i]);
    }
    return result;
  }
  IndexValues rule(Type type, const GatherRead& n) const {
    in_.records_.add(n.stream.id, of(*n.index));
    return all(type, unknown(OnData));
  }
  IndexValues rule(Type type, const NeighborRead& n) const {
    IndexValues index = of(*n.offset);
    for (std::size_t d = 0; d < index.size(); ++d) {
      IndexValue element = unknown(OnElement);
      element.range = elementIndex(d);
      index[d] = combined(Type::of(Scalar::Int), BinaryOp::Add, element, index[d]);
    }
    in_.records_.add(n.stream.id, index);
    return all(type, unknown(OnData));
  }
  IndexValues rule(Type type, const Sample& n) const {
    in_.records_.addUnknown(n.stream.id, dependsOf(of(*n.position)));
    return all(type, unknown(OnData));
  }
  IndexValues rule(Type, const IndexOf& n) const {
    return perDimension(n.stream, OnElement, [](std::size_t d) { return elementIndex(d); });
  }
  IndexValues rule(Type, const ExtentOf& n) const {
    return perDimension(n.stream, OnNothing, [](std::size_t d) { return domainExtent(d); });
  }

  /// An int4 of which the domain's ranges are known. Those of other streams are the same if their extents are.
  template <class RangeOf>
  IndexValues perDimension(StreamRef stream, std::uint8_t depends, const RangeOf& range) const {
    const bool isDomain =
        stream.space == StreamRef::Space::Domain || in_.kernel_.params[stream.id].role == ParamRole::Output;
    IndexValues result(dimensions, unknown(depends));
    if (!isDomain && stream.id >= 64) return result;
    for (std::size_t d = 0; d < dimensions; ++d) {
      result[d].range = range(d);
      if (!isDomain) result[d].range->shapes = std::uint64_t{1} << stream.id;
    }
    return result;
  }

  const IndexExpressions& in_;
};

IndexValues IndexExpressions::of(const Expr& expr) const { return IndexRule(*this).of(expr); }

IndexValues IndexExpressions::binary(BinaryOp op, Type type, const IndexValues& lhs,
                                     const IndexValues& rhs) const {
  IndexValues result(leafCount(module_, type), unknown(dependsOf(lhs) | dependsOf(rhs)));
  if (!type.isInteger()) return result;
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = combined(type, op, component(lhs, i), component(rhs, i));
  return result;
}

// ---- conditions ---------------------------------------------------------------------------------

void IndexExpressions::learn(const Expr& condition, bool isTrue) {
  if (const auto* n = std::get_if<Unary>(&condition.node)) {
    if (n->op == UnaryOp::LogicalNot) learn(*n->operand, !isTrue);
    return;
  }
  const auto* n = std::get_if<Binary>(&condition.node);
  if (n == nullptr) return;
  if (n->op == (isTrue ? BinaryOp::LogicalAnd : BinaryOp::LogicalOr)) {
    learn(*n->lhs, isTrue);
    learn(*n->rhs, isTrue);
    return;
  }
  const Expr &lhs = *n->lhs, &rhs = *n->rhs;
  if (!lhs.type.isScalar() || !lhs.type.isInteger()) return;
  if (n->op == BinaryOp::Less) isTrue ? learnOrder(lhs, rhs, 1) : learnOrder(rhs, lhs, 0);
  if (n->op == BinaryOp::LessEqual) isTrue ? learnOrder(lhs, rhs, 0) : learnOrder(rhs, lhs, 1);
  if (n->op == BinaryOp::Greater) isTrue ? learnOrder(rhs, lhs, 1) : learnOrder(lhs, rhs, 0);
  if (n->op == BinaryOp::GreaterEqual) isTrue ? learnOrder(rhs, lhs, 0) : learnOrder(lhs, rhs, 1);
  if (n->op == (isTrue ? BinaryOp::Equal : BinaryOp::NotEqual)) {
    learnOrder(lhs, rhs, 0);
    learnOrder(rhs, lhs, 0);
  }
}

/// low + gap <= high.
void IndexExpressions::learnOrder(const Expr& low, const Expr& high, std::int64_t gap) {
  const IndexValue from = of(low).front(), to = of(high).front();
  if (to.range) limit(low, *to.range, gap, true);
  if (from.range) limit(high, *from.range, gap, false);
}

/// `place` is at most bound - gap, or at least bound + gap. It may be a variable, a component of one or of the
/// element's index, or one of these and a constant.
void IndexExpressions::limit(const Expr& place, const IndexRange& bound, std::int64_t gap, bool isAbove) {
  if (const auto* n = std::get_if<Binary>(&place.node)) {
    const IndexValue by = of(*n->rhs).front();
    const std::optional<std::int64_t> constant = by.range ? constantOf(by.range->value) : std::nullopt;
    if (!constant || place.type.scalar != Scalar::Int) return;
    if (n->op == BinaryOp::Add) limit(*n->lhs, difference(bound, rangeOf(exactly(*constant))), gap, isAbove);
    if (n->op == BinaryOp::Sub) limit(*n->lhs, sum(bound, rangeOf(exactly(*constant))), gap, isAbove);
    return;
  }
  IndexValue value = of(place).front();
  if (!value.isSet) return;
  const IndexRange range = value.range.value_or(IndexRange());
  value.range = isAbove ? atMost(range, bound, gap) : atLeast(range, bound, gap);
  state_.element = learned(state_.element, *value.range);
  const auto* swizzled = std::get_if<Swizzle>(&place.node);
  const auto* var = std::get_if<VarRef>(swizzled != nullptr ? &swizzled->base->node : &place.node);
  if (var == nullptr || state_.variables[var->var].empty()) return;
  state_.variables[var->var][swizzled != nullptr ? swizzled->components.front() : 0] = value;
}

// ---- assignments --------------------------------------------------------------------------------

void IndexExpressions::assign(const Expr& place, IndexValues value) {
  if (const auto* n = std::get_if<VarRef>(&place.node)) {
    state_.variables[n->var] = std::move(value);
    return;
  }
  if (const auto* n = std::get_if<Member>(&place.node)) {
    IndexValues base = of(*n->base);
    std::ranges::copy(value, base.begin() + offset(firstLeaf(module_, n->base->type, n->field)));
    return assign(*n->base, std::move(base));
  }
  if (const auto* n = std::get_if<Swizzle>(&place.node)) {
    IndexValues base = of(*n->base);
    for (std::size_t i = 0; i < value.size(); ++i) base[n->components[i]] = value[i];
    return assign(*n->base, std::move(base));
  }
  const auto& n = std::get<ir::Index>(place.node);
  IndexValues base = of(*n.base);
  for (std::size_t i = 0; i < base.size(); ++i)
    base[i] = joined(state_.element, base[i], state_.element, value[i % value.size()]);
  assign(*n.base, std::move(base));
}

namespace {

/// More distances that differ in their Spec parameters count as unknown.
constexpr std::size_t mostDistances = 8;

void keepFarthest(std::vector<Distance>& known, const Distance& distance) {
  const auto alike = std::ranges::find(known, distance.perSpec, &Distance::perSpec);
  if (alike == known.end()) {
    known.push_back(distance);
  } else {
    alike->constant = std::max(alike->constant, distance.constant);
  }
}

Reach::Kind farthest(Reach::Kind a, Reach::Kind b) { return std::max(a, b); }

}  // namespace

ReachRecords::ReachRecords(const Kernel& kernel) {
  for (const KernelParam& param : kernel.params) {
    gathers_.emplace_back().dimensions.resize(param.role == ParamRole::Gather ? param.rank : 0);
  }
}

void ReachRecords::add(std::uint32_t param, const std::vector<IndexValue>& index) {
  Gather& gather = gathers_[param];
  for (std::size_t d = 0; d < gather.dimensions.size(); ++d) {
    Dimension& dimension = gather.dimensions[d];
    const IndexValue& value = index[d];
    if (!value.isSet) continue;
    if (!value.range || !value.range->fromElement[d].isBounded()) {
      dimension.kind =
          farthest(dimension.kind, value.depends == OnNothing ? Reach::Kind::Whole : Reach::Kind::Computed);
      continue;
    }
    gather.shapes |= value.range->shapes;
    dimension.add({*value.range->fromElement[d].negatedLow}, {*value.range->fromElement[d].high});
  }
}

void ReachRecords::Dimension::add(const std::vector<Distance>& before, const std::vector<Distance>& after) {
  for (const Distance& distance : before) keepFarthest(below, distance);
  for (const Distance& distance : after) keepFarthest(above, distance);
  if (std::max(below.size(), above.size()) > mostDistances) kind = farthest(kind, Reach::Kind::Computed);
}

void ReachRecords::merge(const ReachRecords& others) {
  for (std::size_t g = 0; g < gathers_.size(); ++g) {
    const Gather& from = others.gathers_[g];
    gathers_[g].shapes |= from.shapes;
    for (std::size_t d = 0; d < from.dimensions.size(); ++d) {
      Dimension& into = gathers_[g].dimensions[d];
      into.kind = farthest(into.kind, from.dimensions[d].kind);
      into.add(from.dimensions[d].below, from.dimensions[d].above);
    }
  }
}

void ReachRecords::addUnknown(std::uint32_t param, std::uint8_t depends) {
  add(param, std::vector<IndexValue>(dimensions, {true, depends}));
}

void ReachRecords::giveUp() {
  for (Gather& gather : gathers_) {
    for (Dimension& dimension : gather.dimensions) dimension.kind = Reach::Kind::Computed;
  }
}

std::vector<GatherReach> ReachRecords::take() const {
  std::vector<GatherReach> result;
  for (const Gather& gather : gathers_) {
    GatherReach& reach = result.emplace_back();
    for (std::size_t d = 0; d < gather.dimensions.size(); ++d) {
      const Dimension& from = gather.dimensions[d];
      const auto number = static_cast<std::uint8_t>(d);
      if (from.kind != Reach::Kind::Near) {
        reach.reach.push_back({number, from.kind});
        continue;
      }
      const std::size_t count = std::max({from.below.size(), from.above.size(), std::size_t{1}});
      const auto at = [](const std::vector<Distance>& list, std::size_t i) {
        Distance distance = i < list.size() ? list[i] : Distance();
        if (distance.perSpec == Distance().perSpec)
          distance.constant = std::max<std::int64_t>(distance.constant, 0);
        return distance;
      };
      for (std::size_t i = 0; i < count; ++i)
        reach.reach.push_back({number, Reach::Kind::Near, at(from.below, i), at(from.above, i)});
    }
    reach.shapes = gather.shapes;
  }
  return result;
}

}  // namespace skc::analysis
