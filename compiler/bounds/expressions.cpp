// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>

#include "bounds/executor.hpp"
#include "ir/build.hpp"
#include "ir/operators.hpp"
#include "ir/print.hpp"
#include "ir/scalar_operations.hpp"
#include "support/overloaded.hpp"

namespace skc::bounds {

using namespace ir;

/// Notes for each node that has none yet what it comes from.
void Executor::noteOrigin(const KernelGraph::Origin& origin) {
  for (std::size_t id = origins_.size(); id < graph_.size(); ++id) origins_.push_back(origin);
}

Numbers Executor::of(Frame& frame, const Path& path, const Expr& expr) {
  tick(expr.loc);
  const Loc outer = arithmetic_.loc();
  Numbers value = node(frame, path, expr);
  arithmetic_.at(outer);
  noteOrigin({&expr, frame.id});  // operands have noted theirs
  return value;
}

Numbers Executor::node(Frame& frame, const Path& path, const Expr& expr) {
  const auto whole = [&](const Expr& base) { return part(frame, path, expr, of(frame, path, base)); };
  // The operands set places of their own.
  const auto here = [&] { arithmetic_.at(expr.loc.line != 0 ? expr.loc : arithmetic_.loc()); };
  here();
  return match(
      expr.node, [&](const Literal& n) { return Numbers{arithmetic_.literal(expr.type.scalar, n)}; },
      [&](const VarRef& n) { return path.variables.at(n.var); },
      [&](const ConstantRef& n) { return of(frame, path, *module_.constants[n.constant].value); },
      [&](const Unary& n) { return unaryOf(frame, path, n); },
      [&](const Binary& n) { return binaryOf(frame, path, n); },
      [&](const Select& n) { return selectOf(frame, path, n); },
      [&](const Convert& n) {
        Numbers value = of(frame, path, *n.operand);
        for (NodeId& number : value)
          number = arithmetic_.convert(n.operand->type.scalar, expr.type.scalar, number);
        return value;
      },
      [&](const Construct& n) { return constructOf(frame, path, n, size(expr.type)); },
      [&](const Swizzle& n) { return whole(*n.base); }, [&](const Member& n) { return whole(*n.base); },
      [&](const Index& n) { return whole(*n.base); },
      [&](const Call& n) {
        std::vector<Numbers> arguments;
        std::vector<std::optional<std::uint32_t>> streams;
        for (std::size_t i = 0; i < n.args.size(); ++i) {
          const auto* variable = std::get_if<VarRef>(&n.args[i]->node);
          const VarRole role = module_.functions[n.callee].variables[i].role;
          const bool isStream = role == VarRole::Gather || role == VarRole::Element;
          streams.push_back(isStream && variable != nullptr && variable->var < frame.streams.size()
                                ? frame.streams[variable->var]
                                : std::nullopt);
          arguments.push_back(role == VarRole::Gather ? Numbers{} : of(frame, path, *n.args[i]));
        }
        return call(n.callee, std::move(arguments), std::move(streams), expr.loc).result;
      },
      [&](const IntrinsicCall& n) { return intrinsic(frame, path, n, expr.type); },
      [&](const GatherRead& n) {
        return streamRead(frame, n.stream, of(frame, path, *n.index), false, expr.type);
      },
      [&](const NeighborRead& n) {
        return streamRead(frame, n.stream, of(frame, path, *n.offset), true, expr.type);
      },
      [&](const Sample&) -> Numbers {
        throw NotBounded("sample(), whose interpolation depends on the device", expr.loc);
      },
      [&](const IndexOf& n) { return streamNumbers(frame, n.stream, true); },
      [&](const ExtentOf& n) { return streamNumbers(frame, n.stream, false); });
}

NodeId Executor::conditionOf(Frame& frame, const Path& path, const Expr& expr) {
  return graph_.condition(of(frame, path, expr)[0]);
}

// ---- parts ----------------------------------------------------------------------------------------

/// What a Member, Index or Swizzle names of its base.
Numbers Executor::part(Frame& frame, const Path& path, const Expr& expr, const Numbers& all) {
  const std::size_t count = size(expr.type);
  const auto from = [&](std::size_t first) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    return Numbers(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  if (const auto* n = std::get_if<Member>(&expr.node))
    return from(scalarOffset(module_, n->base->type, n->field));
  if (const auto* n = std::get_if<Swizzle>(&expr.node)) {
    Numbers chosen;
    for (const std::uint8_t component : n->components) chosen.push_back(all.at(component));
    return chosen;
  }
  const NodeId index = of(frame, path, *std::get<Index>(expr.node).index)[0];
  const std::size_t length = all.size() / count;
  if (graph_.isExact(index)) {
    const double at = std::clamp(graph_[index].value, 0.0, static_cast<double>(length) - 1);
    return from(static_cast<std::size_t>(at) * count);
  }
  Numbers chosen = from((length - 1) * count);  // an index outside is clamped
  for (std::size_t k = length - 1; k-- > 0;) {
    const NodeId isHere =
        arithmetic_.lessEqual(index, arithmetic_.number(Scalar::Int, static_cast<double>(k)));
    const Numbers element = from(k * count);
    for (std::size_t i = 0; i < count; ++i) chosen[i] = arithmetic_.select(isHere, element[i], chosen[i]);
  }
  return chosen;
}

Numbers Executor::constructOf(Frame& frame, const Path& path, const Construct& n, std::size_t count) {
  Numbers value;
  for (const ExprPtr& arg : n.args) {
    const Numbers part = of(frame, path, *arg);
    value.insert(value.end(), part.begin(), part.end());
  }
  if (value.size() == 1) value.resize(count, value[0]);
  return value;
}

// ---- operators ------------------------------------------------------------------------------------

Numbers Executor::unaryOf(Frame& frame, const Path& path, const Unary& n) {
  Numbers value = of(frame, path, *n.operand);
  const Scalar type = n.operand->type.scalar;
  for (NodeId& number : value) {
    if (n.op == UnaryOp::LogicalNot) {
      number = graph_.negation(graph_.condition(number));
    } else if (graph_.isExact(number) && !isReal(type)) {
      number = arithmetic_.number(type, computed(n.op, type, graph_[number].value));
    } else if (n.op == UnaryOp::Negate) {
      number = arithmetic_.negate(type, number);
    } else {
      throw NotBounded("an operation on the bits of a value that is not constant", arithmetic_.loc());
    }
  }
  return value;
}

Numbers Executor::binaryOf(Frame& frame, const Path& path, const Binary& n) {
  Numbers a = of(frame, path, *n.lhs);
  if (n.op == BinaryOp::LogicalAnd || n.op == BinaryOp::LogicalOr) {
    const bool isAnd = n.op == BinaryOp::LogicalAnd;
    const NodeId left = graph_.condition(a[0]);
    if (graph_.isConstant(left) && (graph_[left].value != 0) != isAnd) return {left};
    const NodeId right = conditionOf(frame, path, *n.rhs);
    return {isAnd ? graph_.conjunction(left, right) : graph_.disjunction(left, right)};
  }
  const Numbers b = of(frame, path, *n.rhs);
  return binary(n.op, n.lhs->type, n.rhs->type, a, b);
}

Numbers Executor::binary(BinaryOp op, Type left, Type right, const Numbers& a, const Numbers& b) {
  if (op == BinaryOp::Mul && left.isMatrix() && !right.isScalar()) return product(left, a, b);
  const bool isEquality = op == BinaryOp::Equal || op == BinaryOp::NotEqual;
  if (isEquality && (left.isMatrix() || left.isVector())) {
    NodeId all = graph_.truth(true);
    for (std::size_t i = 0; i < a.size(); ++i)
      all = graph_.conjunction(all, binary(BinaryOp::Equal, left.scalar, a[i], b.at(i)));
    return {op == BinaryOp::Equal ? all : graph_.negation(all)};
  }
  Numbers value;
  const std::size_t count = std::max(a.size(), b.size());
  for (std::size_t i = 0; i < count; ++i)
    value.push_back(binary(op, left.scalar, a.size() == 1 ? a[0] : a[i], b.size() == 1 ? b[0] : b[i]));
  return value;
}

NodeId Executor::binary(BinaryOp op, Scalar type, NodeId a, NodeId b) {
  if (type == Scalar::Bool && (op == BinaryOp::Equal || op == BinaryOp::NotEqual)) {
    const NodeId x = graph_.condition(a), y = graph_.condition(b);
    const NodeId both = graph_.conjunction(x, y);
    const NodeId same = graph_.disjunction(both, graph_.conjunction(graph_.negation(x), graph_.negation(y)));
    return op == BinaryOp::Equal ? same : graph_.negation(same);
  }
  if (!isReal(type)) return integerOperation(op, type, a, b);
  if (const std::optional<NodeId> truth = comparison(op, a, b)) return *truth;
  switch (op) {
    case BinaryOp::Add: return arithmetic_.add(type, a, b);
    case BinaryOp::Sub: return arithmetic_.subtract(type, a, b);
    case BinaryOp::Mul: return arithmetic_.multiply(type, a, b);
    case BinaryOp::Div: return arithmetic_.divide(type, a, b);
    default: break;
  }
  throw NotBounded(fmt::format("the operator {} of these operands", spelling(op)), arithmetic_.loc());
}

/// Nullopt if the operator compares nothing.
std::optional<NodeId> Executor::comparison(BinaryOp op, NodeId a, NodeId b) {
  switch (op) {
    case BinaryOp::Less: return arithmetic_.less(a, b);
    case BinaryOp::LessEqual: return arithmetic_.lessEqual(a, b);
    case BinaryOp::Greater: return arithmetic_.less(b, a);
    case BinaryOp::GreaterEqual: return arithmetic_.lessEqual(b, a);
    case BinaryOp::Equal: return arithmetic_.equal(a, b);
    case BinaryOp::NotEqual: return graph_.negation(arithmetic_.equal(a, b));
    default: return std::nullopt;
  }
}

NodeId Executor::integerOperation(BinaryOp op, Scalar type, NodeId a, NodeId b) {
  if (graph_.isExact(a) && graph_.isExact(b)) {
    const std::optional<double> known = computed(op, type, graph_[a].value, graph_[b].value);
    if (!known || !isRepresentable(type, *known))
      throw NotBounded("an integer of 64 bits that is too large", arithmetic_.loc());
    return ir::isComparison(op) ? graph_.truth(*known != 0) : arithmetic_.number(type, *known);
  }
  if (type != Scalar::Int && type != Scalar::Uint)
    throw NotBounded(fmt::format("a {} that is not constant", row(type).spelling), arithmetic_.loc());
  if (const std::optional<NodeId> truth = comparison(op, a, b)) return *truth;
  switch (op) {
    case BinaryOp::Add: return arithmetic_.add(type, a, b);
    case BinaryOp::Sub: return arithmetic_.subtract(type, a, b);
    case BinaryOp::Mul: return arithmetic_.multiply(type, a, b);
    case BinaryOp::Div: return arithmetic_.divide(type, a, b);
    case BinaryOp::Rem: return arithmetic_.remainder(type, a, b, Op::Truncate);
    case BinaryOp::ShiftLeft:
      if (graph_.isExact(b) && graph_[b].value >= 0 && graph_[b].value < 31)
        return arithmetic_.multiply(
            type, a, arithmetic_.number(type, std::ldexp(1, static_cast<int>(graph_[b].value))));
      break;
    case BinaryOp::ShiftRight:
      if (graph_.isExact(b) && graph_[b].value >= 0 && graph_[b].value < 31) {
        const NodeId divisor = arithmetic_.number(std::ldexp(1, static_cast<int>(graph_[b].value)));
        Node quotient{.op = Op::Divide, .operands = {a, divisor, noNode}};
        return arithmetic_.step(Op::Floor, type, graph_.add(quotient));
      }
      break;
    default: break;
  }
  throw NotBounded("an operation on the bits of a value that is not constant", arithmetic_.loc());
}

/// Multiplies a matrix, stored by rows, by a matrix or a column: terms are added from the first to the last.
Numbers Executor::product(Type left, const Numbers& a, const Numbers& b) {
  const std::size_t width = left.width, columns = b.size() / width;
  Numbers value;
  for (std::size_t i = 0; i < width * columns; ++i) {
    NodeId sum = noNode;
    for (std::size_t k = 0; k < width; ++k) {
      const NodeId term =
          arithmetic_.multiply(left.scalar, a[i / columns * width + k], b[k * columns + i % columns]);
      sum = k == 0 ? term : arithmetic_.add(left.scalar, sum, term);
    }
    value.push_back(sum);
  }
  return value;
}

Numbers Executor::selectOf(Frame& frame, const Path& path, const Select& n) {
  const Numbers condition = of(frame, path, *n.cond);
  if (condition.size() == 1) {
    const NodeId known = graph_.condition(condition[0]);
    if (graph_.isConstant(known)) return of(frame, path, graph_[known].value != 0 ? *n.yes : *n.no);
  }
  const Numbers yes = of(frame, path, *n.yes), no = of(frame, path, *n.no);
  Numbers value;
  for (std::size_t i = 0; i < yes.size(); ++i)
    value.push_back(arithmetic_.select(condition.size() == 1 ? condition[0] : condition[i], yes[i], no[i]));
  return value;
}

// ---- streams --------------------------------------------------------------------------------------

std::optional<std::uint32_t> Executor::paramOf(Frame& frame, const StreamRef& stream) const {
  switch (stream.space) {
    case StreamRef::Space::Variable:
      return stream.id < frame.streams.size() ? frame.streams[stream.id] : std::nullopt;
    case StreamRef::Space::KernelParameter: return stream.id;
    case StreamRef::Space::Domain: return std::nullopt;
  }
  return std::nullopt;
}

/// An element of a gather. Reads at equal indices have equal values; all others are independent.
Numbers Executor::streamRead(Frame& frame, const StreamRef& stream, const Numbers& at, bool isOffset,
                             Type type) {
  const std::optional<std::uint32_t> p = paramOf(frame, stream);
  if (!p) throw NotBounded("a read of an unknown stream", arithmetic_.loc());
  const KernelParam& param = kernel_.params[*p];
  Numbers key = at;
  key.push_back(isOffset ? 1 : 0);
  const auto [entry, isNew] = reads_.try_emplace({*p, std::move(key)});
  if (!isNew) return entry->second;
  std::vector<std::pair<std::string, Scalar>> names;
  nameNumbers(param.name, type, names);
  const std::size_t number = reads_.size();
  Numbers border;
  if (param.boundary == Boundary::Border && param.border) {
    Path empty{graph_.truth(true), {}, {}};
    border = of(frame, empty, *param.border);
  }
  Numbers value;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& [name, scalar] = names[i];
    const std::optional<Interval> given = rangeOf(options_, param, name);
    Interval range = given.value_or(Interval::whole());
    if (!border.empty() && graph_.isConstant(border[i < border.size() ? i : 0])) {
      const Node& outside = graph_[border[i < border.size() ? i : 0]];
      range = hull(range, widened(Interval::point(outside.value), outside.rounding.amount));
    }
    if (arithmeticScalar(scalar) == Scalar::Bool) throw NotBounded("a gather of bools", arithmetic_.loc());
    value.push_back(
        arithmetic_.read(arithmeticScalar(scalar), fmt::format("{} (read {})", name, number), range));
    lacksRange_.resize(graph_.inputs().size(), false);
    if (!given && !lacksRange_.empty()) lacksRange_.back() = true;
  }
  return entry->second = value;
}

/// indexof or extentof: integers with a range of their own, as "indexof(u).x".
Numbers Executor::streamNumbers(Frame& frame, const StreamRef& stream, bool isIndex) {
  const std::optional<std::uint32_t> p = paramOf(frame, stream);
  KernelParam domain{};
  domain.name = "domain";
  const KernelParam& param = p ? kernel_.params[*p] : domain;
  const std::string name = fmt::format("{}({})", isIndex ? "indexof" : "extentof", param.name);
  return readParameter(name, param, Type::of(Scalar::Int, 4));
}

}  // namespace skc::bounds
