// SPDX-License-Identifier: MIT
#include "analysis/shapes.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "ir/walk.hpp"
#include "support/overloaded.hpp"

namespace skc::analysis {

using namespace ir;

std::size_t leafCount(const Module& module, Type type) {
  switch (type.kind) {
    case Type::Kind::Void: return 0;
    case Type::Kind::Scalar:
    case Type::Kind::Vector: return type.width;
    case Type::Kind::Matrix: return std::size_t{type.width} * type.width;
    case Type::Kind::Array: return leafCount(module, module.arrays[type.index].element);
    case Type::Kind::Struct: break;
  }
  std::size_t count = 0;
  for (const StructField& field : module.structs[type.index].fields) count += leafCount(module, field.type);
  return count;
}

std::size_t firstLeaf(const Module& module, Type type, std::uint32_t field) {
  std::size_t first = 0;
  const std::vector<StructField>& fields = module.structs[type.index].fields;
  for (std::uint32_t i = 0; i < field; ++i) first += leafCount(module, fields[i].type);
  return first;
}

std::optional<std::uint32_t> literalIndex(const Expr& index, std::uint32_t length) {
  const auto* n = std::get_if<Literal>(&index.node);
  return n != nullptr && n->bits < length ? std::optional(n->bits) : std::nullopt;
}

LeafShape join(LeafShape a, LeafShape b) {
  if (!a || !b) return a ? a : b;
  return a == b ? a : Shape::Varying;
}

LeafShape join(const LeafShapes& leaves) {
  LeafShape all;
  for (const LeafShape leaf : leaves) all = join(all, leaf);
  return all;
}

namespace {

/// The shape of the result of an operation that preserves only uniformity.
LeafShape mixed(LeafShape a, LeafShape b) {
  if (!a || !b) return std::nullopt;
  return isVarying(a) || isVarying(b) ? Shape::Varying : Shape::Uniform;
}
LeafShape mixed(LeafShape a) { return mixed(a, a); }

LeafShape mixed(const LeafShapes& leaves) {
  LeafShape all = Shape::Uniform;
  for (const LeafShape leaf : leaves) all = mixed(all, leaf);
  return all;
}

/// Adding or subtracting a uniform int preserves Consecutive.
LeafShape moved(BinaryOp op, LeafShape lhs, LeafShape rhs) {
  const bool isAdd = op == BinaryOp::Add;
  if (lhs == Shape::Consecutive && rhs == Shape::Uniform) return lhs;
  if (isAdd && lhs == Shape::Uniform && rhs == Shape::Consecutive) return rhs;
  return mixed(lhs, rhs);
}

bool isComponentwise(Intrinsic intrinsic) {
  using enum Intrinsic;
  static constexpr Intrinsic others[] = {Cross,   Normalize, Faceforward, Reflect,
                                         Refract, Transpose, Inverse,     ExactSettled};
  return std::ranges::find(others, intrinsic) == std::end(others);
}

}  // namespace

/// One rule for each kind of expression.
class ExprRule {
 public:
  ExprRule(const ExprShapes& shapes, FunctionId function)
      : module_(shapes.module_),
        kernel_(shapes.kernel_),
        shapes_(shapes.shapes_),
        axis_(shapes.axis_),
        function_(function) {}

  LeafShapes of(const Expr& expr) const {
    return match(expr.node, [&](const auto& node) { return rule(expr.type, node); });
  }

  LeafShapes binary(BinaryOp op, Type type, const Expr& left, const Expr& right) const {
    const LeafShapes lhs = of(left), rhs = of(right);
    if (left.type.isMatrix() || right.type.isMatrix() || !type.isArithmetic() ||
        !(left.type.isArithmetic() && right.type.isArithmetic()))
      return all(type, mixed(mixed(lhs), mixed(rhs)));
    const bool moves = (op == BinaryOp::Add || op == BinaryOp::Sub) && type.isInteger();
    return componentwise(type, lhs, rhs,
                         [&](LeafShape a, LeafShape b) { return moves ? moved(op, a, b) : mixed(a, b); });
  }

  /// Wraps the leaves assigned to `place` in the leaves of the variable at its root.
  LeafShapes assigned(const Expr& place, LeafShapes value) const {
    if (const auto* n = std::get_if<Member>(&place.node)) {
      LeafShapes base(leafCount(module_, n->base->type));
      std::ranges::copy(value, base.begin() + offset(firstLeaf(module_, n->base->type, n->field)));
      return assigned(*n->base, std::move(base));
    }
    if (const auto* n = std::get_if<Swizzle>(&place.node)) {
      LeafShapes base(n->base->type.width);
      for (std::size_t i = 0; i < value.size(); ++i) base[n->components[i]] = value[i];
      return assigned(*n->base, std::move(base));
    }
    if (const auto* n = std::get_if<ir::Index>(&place.node)) return assigned(*n->base, indexed(*n, value));
    return value;
  }

 private:
  static std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }
  LeafShapes all(Type type, LeafShape leaf) const { return LeafShapes(leafCount(module_, type), leaf); }
  LeafShapes uniform(Type type) const { return all(type, Shape::Uniform); }

  template <class Fn>
  LeafShapes componentwise(Type type, const LeafShapes& lhs, const LeafShapes& rhs, Fn&& fn) const {
    LeafShapes result;
    const std::size_t count = leafCount(module_, type);
    for (std::size_t i = 0; i < count; ++i) result.push_back(fn(component(lhs, i), component(rhs, i)));
    return result;
  }
  /// A scalar is broadcast to all components.
  static LeafShape component(const LeafShapes& leaves, std::size_t i) {
    return leaves.size() == 1 ? leaves.front() : leaves[i];
  }

  /// The leaves of the whole after an assignment to one of its elements.
  LeafShapes indexed(const ir::Index& n, const LeafShapes& value) const {
    LeafShapes base(leafCount(module_, n.base->type));
    if (isVarying(join(of(*n.index)))) {
      std::ranges::fill(base, LeafShape(Shape::Varying));
      return base;
    }
    const std::optional<std::uint32_t> known =
        n.base->type.kind == Type::Kind::Array ? 0 : literalIndex(*n.index, n.base->type.width);
    for (std::size_t i = 0; i < base.size(); ++i) {
      if (!known || i / value.size() == *known) base[i] = value[i % value.size()];
    }
    return base;
  }

  LeafShapes rule(Type type, const Literal&) const { return uniform(type); }
  LeafShapes rule(Type type, const ConstantRef&) const { return uniform(type); }
  LeafShapes rule(Type, const VarRef& n) const { return shapes_.at(function_).variables[n.var]; }
  LeafShapes rule(Type, const Unary& n) const { return each(of(*n.operand)); }
  LeafShapes rule(Type type, const Binary& n) const { return binary(n.op, type, *n.lhs, *n.rhs); }
  LeafShapes rule(Type type, const Select& n) const {
    const LeafShapes cond = of(*n.cond), yes = of(*n.yes), no = of(*n.no);
    LeafShapes result;
    for (std::size_t i = 0; i < leafCount(module_, type); ++i) {
      const LeafShape chooses = component(cond, i);
      result.push_back(!chooses ? std::nullopt : isVarying(chooses) ? Shape::Varying : join(yes[i], no[i]));
    }
    return result;
  }
  LeafShapes rule(Type type, const Convert& n) const {
    const bool keeps = type.isInteger() && n.operand->type.isInteger();
    return keeps ? of(*n.operand) : each(of(*n.operand));
  }
  LeafShapes rule(Type type, const Construct& n) const {
    if (type.kind == Type::Kind::Array) {
      LeafShapes result = of(*n.args.front());
      for (const ExprPtr& arg : n.args) merge(result, of(*arg));
      return result;
    }
    LeafShapes result;
    for (const ExprPtr& arg : n.args) std::ranges::copy(of(*arg), std::back_inserter(result));
    const bool isSplat = type.isVector() && result.size() == 1;
    return isSplat ? all(type, result.front()) : result;
  }
  LeafShapes rule(Type, const Swizzle& n) const {
    const LeafShapes base = of(*n.base);
    LeafShapes result;
    for (const std::uint8_t component : n.components) result.push_back(base[component]);
    return result;
  }
  LeafShapes rule(Type type, const Member& n) const {
    const LeafShapes base = of(*n.base);
    const auto first = base.begin() + offset(firstLeaf(module_, n.base->type, n.field));
    return LeafShapes(first, first + offset(leafCount(module_, type)));
  }
  LeafShapes rule(Type type, const ir::Index& n) const {
    if (isVarying(join(of(*n.index)))) return all(type, Shape::Varying);
    const LeafShapes base = of(*n.base);
    if (n.base->type.kind == Type::Kind::Array) return base;
    const std::size_t size = leafCount(module_, type);
    if (const auto known = literalIndex(*n.index, n.base->type.width)) {
      const auto first = base.begin() + offset(*known * size);
      return LeafShapes(first, first + offset(size));
    }
    LeafShapes result(size);
    for (std::size_t i = 0; i < base.size(); ++i) result[i % size] = join(result[i % size], base[i]);
    return result;
  }
  LeafShapes rule(Type, const Call& n) const { return shapes_.at(n.callee).result; }
  LeafShapes rule(Type type, const IntrinsicCall& n) const {
    if (n.intrinsic == Intrinsic::AnyLane && axis_ == Axis::X) return uniform(type);
    LeafShapes result = uniform(type);
    for (const ExprPtr& arg : n.args) {
      const LeafShapes leaves = of(*arg);
      const bool fits = leaves.size() == 1 || leaves.size() == result.size();
      const LeafShape whole = mixed(leaves);
      for (std::size_t i = 0; i < result.size(); ++i) {
        result[i] = mixed(result[i], fits && isComponentwise(n.intrinsic) ? component(leaves, i) : whole);
      }
    }
    return result;
  }
  LeafShapes rule(Type type, const GatherRead& n) const { return all(type, mixed(of(*n.index))); }
  LeafShapes rule(Type type, const NeighborRead&) const { return all(type, Shape::Varying); }
  LeafShapes rule(Type type, const Sample& n) const { return all(type, mixed(of(*n.position))); }
  /// Lanes are consecutive elements along x, except in a fold, whose lanes may be farther apart. An input's
  /// index is computed from the domain's by a multiplication and a division.
  LeafShapes rule(Type type, const IndexOf& n) const {
    LeafShapes result = uniform(type);
    if (axis_ == Axis::Y) {
      result[1] = Shape::Varying;
      return result;
    }
    const bool isInput = n.stream.space == StreamRef::Space::KernelParameter &&
                         kernel_.params[n.stream.id].role == ParamRole::Input;
    result[0] = isInput || kernel_.reduction ? Shape::Varying : Shape::Consecutive;
    return result;
  }
  LeafShapes rule(Type type, const ExtentOf&) const { return uniform(type); }

  static LeafShapes each(LeafShapes leaves) {
    for (LeafShape& leaf : leaves) leaf = mixed(leaf);
    return leaves;
  }
  static void merge(LeafShapes& into, const LeafShapes& from) {
    for (std::size_t i = 0; i < into.size(); ++i) into[i] = join(into[i], from[i]);
  }

  const Module& module_;
  const Kernel& kernel_;
  const KernelShapes& shapes_;
  Axis axis_;
  FunctionId function_;
};

LeafShapes ExprShapes::of(FunctionId function, const Expr& expr) const {
  return ExprRule(*this, function).of(expr);
}

LeafShapes ExprShapes::ofCompound(FunctionId function, const Expr& place, BinaryOp op,
                                  const Expr& value) const {
  return ExprRule(*this, function).binary(op, place.type, place, value);
}

LeafShapes ExprShapes::assigned(FunctionId function, const Expr& place, LeafShapes value) const {
  return ExprRule(*this, function).assigned(place, std::move(value));
}

}  // namespace skc::analysis
