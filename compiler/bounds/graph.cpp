// SPDX-License-Identifier: MIT
#include "bounds/graph.hpp"

#include <bit>
#include <cmath>
#include <utility>

namespace skc::bounds {
namespace {

bool isScale(double x) {
  int exponent;
  return x != 0 && std::isfinite(x) && std::fabs(std::frexp(x, &exponent)) == 0.5;
}

/// True if the format has the number.
bool holds(const Format& format, double x) {
  if (x == 0) return true;
  if (!(std::fabs(x) <= format.largest) || std::fabs(x) < format.smallest) return false;
  int exponent;
  const double scaled = std::frexp(x, &exponent) / format.unit;
  return std::floor(scaled) == scaled;
}

/// The exact result of an operation on constants, if a double holds it. Residues of fused operations show what rounding lost.
bool computeExactly(Op op, double x, double y, double& result) {
  if (op == Op::Add || op == Op::Subtract) {
    const double b = op == Op::Add ? y : -y, sum = x + b, part = sum - x;
    result = sum;
    return std::isfinite(sum) && (x - (sum - part)) + (b - part) == 0;
  }
  if (op == Op::Multiply) {
    result = x * y;
    return std::isfinite(result) && std::fma(x, y, -result) == 0 &&
           (result == 0 || std::fabs(result) > 0x1p-900);
  }
  if (op == Op::Divide && y != 0) {
    result = x / y;
    return std::isfinite(result) && std::fma(result, y, -x) == 0 && (x == 0 || std::fabs(result) > 0x1p-900);
  }
  return false;
}

double stepped(Op op, double x) {
  switch (op) {
    case Op::Floor: return std::floor(x);
    case Op::Ceil: return std::ceil(x);
    case Op::Truncate: return std::trunc(x);
    default: return std::nearbyint(x);
  }
}

std::uint64_t mixed(std::uint64_t hash, std::uint64_t value) {
  return (hash ^ value) * 0x9e3779b97f4a7c15u + (hash >> 29);
}

std::uint64_t hashOf(const Node& node) {
  std::uint64_t hash = static_cast<std::uint64_t>(node.op) << 16 |
                       static_cast<std::uint64_t>(node.function) << 8 |
                       static_cast<std::uint64_t>(node.function2);
  for (const NodeId operand : node.operands) hash = mixed(hash, operand);
  hash = mixed(hash, node.index);
  hash = mixed(hash, std::bit_cast<std::uint64_t>(node.value));
  hash = mixed(hash, static_cast<std::uint64_t>(node.rounding.kind));
  return mixed(hash, std::bit_cast<std::uint64_t>(node.rounding.amount + node.rounding.format.unit));
}

bool areSame(const Node& a, const Node& b) {
  return a.op == b.op && a.function == b.function && a.function2 == b.function2 && a.operands == b.operands &&
         a.index == b.index &&
         std::bit_cast<std::uint64_t>(a.value) == std::bit_cast<std::uint64_t>(b.value) &&
         a.rounding == b.rounding && a.integer == b.integer;
}

}  // namespace

NodeId Graph::unique(const Node& node) {
  const std::uint64_t hash = hashOf(node);
  const auto [first, last] = known_.equal_range(hash);
  for (auto it = first; it != last; ++it) {
    if (areSame(nodes_[it->second], node)) return it->second;
  }
  const auto id = static_cast<NodeId>(nodes_.size());
  nodes_.push_back(node);
  known_.emplace(hash, id);
  return id;
}

NodeId Graph::input(Input input, Rounding rounding, Integer integer) {
  Node node{.op = Op::Input, .index = static_cast<std::uint32_t>(inputs_.size()), .rounding = rounding};
  node.integer = integer;
  inputs_.push_back(std::move(input));
  return unique(node);
}

NodeId Graph::constant(double value, Rounding rounding, Integer integer) {
  Node node{.op = Op::Constant, .value = value == 0 ? 0 : value, .rounding = rounding};
  node.integer = integer;
  return unique(node);
}

/// Sees operations that multiply by a power of 2.
void Graph::noteScaling(Node& node) const {
  const NodeId a = node.operands[0], b = node.operands[1];
  const auto scales = [&](NodeId id) { return isExact(id) && isScale(nodes_[id].value); };
  if (node.op == Op::Add && a == b) {
    node.rounding.isScaling = node.rounding.isGrowing = true;
  } else if (node.op == Op::Divide && scales(b)) {
    node.rounding.isScaling = true;
    node.rounding.isGrowing = std::fabs(nodes_[b].value) <= 1;
  } else if (node.op == Op::Multiply && (scales(a) || scales(b))) {
    node.rounding.isScaling = true;
    node.rounding.isGrowing = std::fabs(nodes_[scales(a) ? a : b].value) >= 1;
  }
}

NodeId Graph::add(Node node) {
  if (const NodeId known = simplified(node); known != noNode) return known;
  if (node.rounding.kind == Rounding::Kind::Nearest) noteScaling(node);
  const bool commutes = node.op == Op::Add || node.op == Op::Multiply || node.op == Op::Min ||
                        node.op == Op::Max || node.op == Op::Equal;
  if (commutes && node.operands[0] > node.operands[1]) std::swap(node.operands[0], node.operands[1]);
  return unique(node);
}

/// A node that has the value already, or noNode.
NodeId Graph::simplified(const Node& node) {
  const NodeId a = node.operands[0], b = node.operands[1];
  const auto known = [&](NodeId id) { return id != noNode && isExact(id); };
  const double x = known(a) ? nodes_[a].value : 0, y = known(b) ? nodes_[b].value : 0;
  const auto folded = [&](double value) { return constant(value, {}, node.integer); };
  const bool isRounded = node.rounding.kind != Rounding::Kind::Exact;
  switch (node.op) {
    case Op::Add:
      if (isConstant(a, 0)) return b;
      if (isConstant(b, 0)) return a;
      break;
    case Op::Subtract:
      if (isConstant(b, 0)) return a;
      if (a == b) return folded(0);
      break;
    case Op::Multiply:
      if (isConstant(a, 1)) return b;
      if (isConstant(b, 1)) return a;
      if (isConstant(a, 0) || isConstant(b, 0)) return folded(0);
      if (isConstant(a, -1)) return add({.op = Op::Negate, .operands = {b, noNode, noNode}, .loc = node.loc});
      if (isConstant(b, -1)) return add({.op = Op::Negate, .operands = {a, noNode, noNode}, .loc = node.loc});
      break;
    case Op::Divide:
      if (isConstant(b, 1)) return a;
      if (isConstant(b, -1)) return add({.op = Op::Negate, .operands = {a, noNode, noNode}, .loc = node.loc});
      break;
    case Op::Negate:
      if (known(a)) return folded(-x);
      if (nodes_[a].op == Op::Negate) return nodes_[a].operands[0];
      break;
    case Op::Absolute:
      if (known(a)) return folded(std::fabs(x));
      break;
    case Op::Min:
    case Op::Max:
      if (a == b) return a;
      if (known(a) && known(b)) return folded(node.op == Op::Min ? std::fmin(x, y) : std::fmax(x, y));
      break;
    case Op::Floor:
    case Op::Ceil:
    case Op::Truncate:
    case Op::RoundEven:
      if (known(a)) return folded(stepped(node.op, x));
      if (nodes_[a].integer != Integer::No) return a;
      break;
    case Op::Round:
      if (known(a) && node.rounding.kind == Rounding::Kind::Nearest && holds(node.rounding.format, x))
        return a;
      break;
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
      if (a == b) return truth(node.op != Op::Less);
      if (known(a) && known(b)) {
        return truth(node.op == Op::Less ? x < y : node.op == Op::LessEqual ? x <= y : x == y);
      }
      break;
    case Op::Input:
    case Op::Constant:
    case Op::MultiplyAdd:
    case Op::Call:
    case Op::Call2:
    case Op::Select:
    case Op::And:
    case Op::Or:
    case Op::Not: break;
  }
  double result = 0;
  if (known(a) && known(b) && computeExactly(node.op, x, y, result) &&
      (!isRounded ||
       (node.rounding.kind == Rounding::Kind::Nearest && holds(node.rounding.format, result)))) {
    return folded(result);
  }
  return noNode;
}

// ---- conditions -----------------------------------------------------------------------------------

NodeId Graph::negation(NodeId a) {
  if (isConstant(a)) return truth(nodes_[a].value == 0);
  if (nodes_[a].op == Op::Not) return nodes_[a].operands[0];
  return add({.op = Op::Not, .operands = {a, noNode, noNode}, .loc = nodes_[a].loc});
}

NodeId Graph::conjunction(NodeId a, NodeId b) {
  if (isConstant(a)) return nodes_[a].value != 0 ? b : a;
  if (isConstant(b)) return nodes_[b].value != 0 ? a : b;
  if (a == b) return a;
  if (negation(a) == b) return truth(false);
  return add({.op = Op::And, .operands = {a, b, noNode}, .loc = nodes_[b].loc});
}

NodeId Graph::disjunction(NodeId a, NodeId b) {
  if (isConstant(a)) return nodes_[a].value != 0 ? a : b;
  if (isConstant(b)) return nodes_[b].value != 0 ? b : a;
  if (a == b) return a;
  if (negation(a) == b) return truth(true);
  // Both ways through a branch: (p and c) or (p and not c) is p.
  const Node &left = nodes_[a], &right = nodes_[b];
  if (left.op == Op::And && right.op == Op::And && left.operands[0] == right.operands[0]) {
    const NodeId path = left.operands[0], one = left.operands[1], other = right.operands[1];
    return conjunction(path, disjunction(one, other));
  }
  return add({.op = Op::Or, .operands = {a, b, noNode}, .loc = nodes_[a].loc});
}

/// A choice that is the smaller, the larger or the magnitude: these have no jump where rounding flips the condition.
NodeId Graph::extreme(NodeId condition, NodeId yes, NodeId no, Loc loc) {
  const Node& compared = nodes_[condition];
  if (compared.op != Op::Less && compared.op != Op::LessEqual) return noNode;
  const NodeId a = compared.operands[0], b = compared.operands[1];
  Node node{.op = Op::Min, .operands = {yes, no, noNode}, .integer = nodes_[yes].integer};
  node.loc = loc;
  if (yes == a && no == b) return add(node);
  node.op = Op::Max;
  if (yes == b && no == a) return add(node);
  node.op = Op::Absolute;
  const auto isNegativeOf = [&](NodeId id, NodeId x) {
    return nodes_[id].op == Op::Negate && nodes_[id].operands[0] == x;
  };
  node.operands = {a, noNode, noNode};
  if (isConstant(b, 0) && no == a && isNegativeOf(yes, a)) return add(node);  // x < 0 ? -x : x
  node.operands = {b, noNode, noNode};
  if (isConstant(a, 0) && yes == b && isNegativeOf(no, b)) return add(node);  // 0 < x ? x : -x
  return noNode;
}

NodeId Graph::select(NodeId condition, NodeId yes, NodeId no, Loc loc) {
  if (isConstant(condition)) return nodes_[condition].value != 0 ? yes : no;
  if (yes == no) return yes;
  if (nodes_[condition].op == Op::Not) return select(nodes_[condition].operands[0], no, yes, loc);
  if (const NodeId known = extreme(condition, yes, no, loc); known != noNode) return known;
  Node node{.op = Op::Select, .operands = {condition, yes, no}};
  if (nodes_[yes].integer == nodes_[no].integer) node.integer = nodes_[yes].integer;
  node.loc = loc;
  if (isCondition(nodes_[yes].op) || isCondition(nodes_[no].op)) {
    const NodeId whenTrue = conjunction(condition, this->condition(yes));
    const NodeId whenFalse = conjunction(negation(condition), this->condition(no));
    return disjunction(whenTrue, whenFalse);
  }
  return add(node);
}

NodeId Graph::condition(NodeId value) {
  const Node node = nodes_[value];
  if (node.op != Op::Select) return value;
  const NodeId whenTrue = conjunction(node.operands[0], condition(node.operands[1]));
  const NodeId whenFalse = conjunction(negation(node.operands[0]), condition(node.operands[2]));
  return disjunction(whenTrue, whenFalse);
}

std::vector<NodeId> Graph::neededBy(const std::vector<NodeId>& roots) const {
  std::vector<bool> isNeeded(nodes_.size(), false);
  for (const NodeId root : roots) isNeeded[root] = true;
  // Operands have smaller numbers than the nodes that use them.
  for (std::size_t id = nodes_.size(); id-- > 0;) {
    if (!isNeeded[id]) continue;
    for (const NodeId operand : nodes_[id].operands) {
      if (operand != noNode) isNeeded[operand] = true;
    }
  }
  std::vector<NodeId> needed;
  for (std::size_t id = 0; id < nodes_.size(); ++id) {
    if (isNeeded[id]) needed.push_back(static_cast<NodeId>(id));
  }
  return needed;
}

}  // namespace skc::bounds
