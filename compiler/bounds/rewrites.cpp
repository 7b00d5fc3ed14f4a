// SPDX-License-Identifier: MIT
#include "bounds/rewrites.hpp"

#include <algorithm>
#include <optional>

#include "bounds/arithmetic.hpp"

namespace skc::bounds {
namespace {

using ir::Scalar;

/// Copies what an output needs, and replaces nodes that a rule knows.
class Rewriter {
 public:
  Rewriter(Graph& graph, const Options& options) : graph_(graph), options_(options), f_(graph, options) {}

  /// A rule looks at a node whose operands are copies already. It returns noNode for a node that it does not know.
  using Rule = NodeId (Rewriter::*)(const Node&);

  std::optional<NodeId> rewrite(NodeId output, Rule rule) {
    bool isChanged = false;
    std::vector<NodeId> copies(graph_.size(), noNode);
    for (const NodeId id : graph_.neededBy({output})) {
      Node node = graph_[id];
      if (node.op == Op::Input || node.op == Op::Constant) {
        copies[id] = id;
        continue;
      }
      for (NodeId& operand : node.operands) {
        if (operand != noNode) operand = copies[operand];
      }
      f_.at(node.loc);
      const NodeId replaced = isCondition(node.op) ? noNode : (this->*rule)(node);
      isChanged = isChanged || replaced != noNode;
      copies[id] = replaced != noNode ? replaced : graph_.add(node);
    }
    if (!isChanged) return std::nullopt;
    return copies[output];
  }

  // sqrt(a) - sqrt(b), sqrt(a) - 1
  NodeId roots(const Node& node) {
    if (node.op != Op::Subtract) return noNode;
    const auto [x, y] = operands(node);
    const NodeId a = argument(x, UnaryFunction::Sqrt);
    NodeId b = argument(y, UnaryFunction::Sqrt);
    if (b == noNode && graph_.isConstant(y, 1)) b = y;
    if (a == noNode || b == noNode) return noNode;
    const Scalar type = typeOf(node);
    return f_.divide(type, difference(type, a, b), f_.add(type, x, y));
  }

  // 1 - cos(x)
  NodeId cosine(const Node& node) {
    if (node.op != Op::Subtract || !graph_.isConstant(node.operands[0], 1)) return noNode;
    const NodeId x = argument(node.operands[1], UnaryFunction::Cos);
    if (x == noNode) return noNode;
    const Scalar type = typeOf(node);
    const NodeId half = f_.call(type, UnaryFunction::Sin, f_.multiply(type, f_.number(0.5), x));
    return f_.multiply(type, f_.number(2), f_.multiply(type, half, half));
  }

  // exp(x) - 1
  NodeId exponential(const Node& node) {
    if (node.op != Op::Subtract || !graph_.isConstant(node.operands[1], 1)) return noNode;
    const NodeId x = argument(node.operands[0], UnaryFunction::Exp);
    return x == noNode ? noNode : f_.call(typeOf(node), UnaryFunction::Expm1, x);
  }

  // log(1 + x)
  NodeId logarithm(const Node& node) {
    if (node.op != Op::Call || node.function != UnaryFunction::Log) return noNode;
    const Node& sum = graph_[node.operands[0]];
    if (sum.op != Op::Add) return noNode;
    const auto [a, b] = operands(sum);
    const NodeId x = graph_.isConstant(a, 1) ? b : graph_.isConstant(b, 1) ? a : noNode;
    return x == noNode ? noNode : f_.call(typeOf(sum), UnaryFunction::Log1p, x);
  }

  // x * x - y * y
  NodeId squares(const Node& node) {
    if (node.op != Op::Subtract) return noNode;
    const NodeId x = root(node.operands[0]), y = root(node.operands[1]);
    if (x == noNode || y == noNode) return noNode;
    const Scalar type = typeOf(node);
    return f_.multiply(type, f_.subtract(type, x, y), f_.add(type, x, y));
  }

  // (sqrt(b * b - p) - b) / q and (-b - sqrt(b * b - p)) / q: the product of both numerators is p.
  NodeId quadratic(const Node& node) {
    if (node.op != Op::Divide) return noNode;
    const auto [numerator, q] = operands(node);
    const Node top = graph_[numerator];
    if (top.op != Op::Add && top.op != Op::Subtract) return noNode;
    for (const bool isSwapped : {false, true}) {
      const NodeId left = top.operands[isSwapped ? 1 : 0], right = top.operands[isSwapped ? 0 : 1];
      const NodeId under = argument(left, UnaryFunction::Sqrt);
      if (under == noNode) continue;
      const bool isRootAdded = top.op == Op::Add || !isSwapped;
      const Node discriminant = graph_[under];
      if (discriminant.op != Op::Subtract) continue;
      const NodeId b = root(discriminant.operands[0]), p = discriminant.operands[1];
      if (b == noNode) continue;
      // The other term is b or -b, with the sign that it has in the numerator.
      const bool isMinus = top.op == Op::Subtract && !isSwapped;
      const bool isB = right == b, isNegated = isNegativeOf(right, b);
      if (!isB && !isNegated) continue;
      const bool isBSubtracted = isB == isMinus;
      const Scalar type = typeOf(node);
      // The numerator is r * s + t * b with signs r and t; times r * s - t * b it is s^2 - b^2 = -p.
      const NodeId s = isRootAdded ? left : f_.negate(type, left);
      const NodeId other = isBSubtracted ? f_.add(type, s, b) : f_.subtract(type, s, b);
      return f_.divide(type, f_.negate(type, p), f_.multiply(type, q, other));
    }
    return noNode;
  }

  // (x1^2 + x2^2 + ...) / n - m * m, of the mean m
  NodeId variance(const Node& node) {
    if (node.op != Op::Subtract) return noNode;
    const NodeId mean = root(node.operands[1]);
    if (mean == noNode) return noNode;
    const std::optional<Mean> ofSquares = meanOf(node.operands[0]), ofNumbers = meanOf(mean);
    if (!ofSquares || !ofNumbers || ofSquares->factor != ofNumbers->factor) return noNode;
    std::vector<NodeId> numbers, roots;
    collect(ofNumbers->sum, numbers);
    collect(ofSquares->sum, roots);
    for (NodeId& square : roots) square = square == noNode ? noNode : root(square);
    std::vector<NodeId> sorted = numbers;
    std::ranges::sort(sorted);
    std::ranges::sort(roots);
    if (sorted != roots || numbers.size() < 2) return noNode;
    const Scalar type = typeOf(node);
    NodeId sum = noNode;
    for (const NodeId number : numbers) {
      const NodeId off = f_.subtract(type, number, mean);
      const NodeId square = f_.multiply(type, off, off);
      sum = sum == noNode ? square : f_.add(type, sum, square);
    }
    Node scaled = graph_[node.operands[0]];
    for (NodeId& operand : scaled.operands) {
      if (operand == ofSquares->sum) operand = sum;
    }
    return graph_.add(scaled);
  }

 private:
  struct Mean {
    NodeId sum, factor;  ///< sum / factor, or sum * factor
  };

  std::optional<Mean> meanOf(NodeId id) const {
    const Node& node = graph_[id];
    const auto [a, b] = operands(node);
    if (node.op == Op::Divide && graph_.isConstant(b)) return Mean{a, b};
    if (node.op == Op::Multiply && graph_.isConstant(b)) return Mean{a, b};
    if (node.op == Op::Multiply && graph_.isConstant(a)) return Mean{b, a};
    return std::nullopt;
  }

  void collect(NodeId sum, std::vector<NodeId>& terms) const {
    if (graph_[sum].op != Op::Add) {
      terms.push_back(sum);
      return;
    }
    collect(graph_[sum].operands[0], terms);
    collect(graph_[sum].operands[1], terms);
  }

  static std::pair<NodeId, NodeId> operands(const Node& node) { return {node.operands[0], node.operands[1]}; }

  /// x, if the node is x * x.
  NodeId root(NodeId id) const {
    const Node& node = graph_[id];
    return node.op == Op::Multiply && node.operands[0] == node.operands[1] ? node.operands[0] : noNode;
  }
  /// The argument of a call of the function.
  NodeId argument(NodeId id, UnaryFunction function) const {
    const Node& node = graph_[id];
    return node.op == Op::Call && node.function == function ? node.operands[0] : noNode;
  }
  bool isNegativeOf(NodeId id, NodeId x) const {
    return graph_[id].op == Op::Negate && graph_[id].operands[0] == x;
  }

  /// a - b, without what both have in common.
  NodeId difference(Scalar type, NodeId a, NodeId b) {
    const Node left = graph_[a], right = graph_[b];
    const auto without = [](const Node& sum, NodeId term) {
      if (sum.op != Op::Add) return noNode;
      return sum.operands[0] == term ? sum.operands[1] : sum.operands[1] == term ? sum.operands[0] : noNode;
    };
    if (const NodeId rest = without(left, b); rest != noNode) return rest;
    if (const NodeId rest = without(right, a); rest != noNode) return f_.negate(type, rest);
    if (left.op == Op::Subtract && left.operands[0] == b) return f_.negate(type, left.operands[1]);
    if (right.op == Op::Subtract && right.operands[0] == a) return right.operands[1];
    if (left.op == Op::Add && right.op == Op::Add) {
      for (const NodeId term : {left.operands[0], left.operands[1]}) {
        const NodeId other = without(right, term);
        if (other != noNode) return f_.subtract(type, without(left, term), other);
      }
    }
    return f_.subtract(type, a, b);
  }

  /// The type that an operation is of, by its format.
  Scalar typeOf(const Node& node) const {
    const bool isDouble = node.rounding.format.unit == doubleFormat.unit;
    const bool areFloatsDoubles =
        options_.precision == Precision::Double || options_.precision == Precision::Extended;
    return isDouble && !areFloatsDoubles ? Scalar::Double : Scalar::Float;
  }

  Graph& graph_;
  const Options& options_;
  Arithmetic f_;
};

struct Row {
  Rewriter::Rule rule;
  const char *from, *to;
};

constexpr Row rows[] = {
    {&Rewriter::roots, "sqrt(a) - sqrt(b)", "(a - b) / (sqrt(a) + sqrt(b))"},
    {&Rewriter::cosine, "1 - cos(x)", "2 * sin(x / 2) * sin(x / 2)"},
    {&Rewriter::exponential, "exp(x) - 1", "expm1(x)"},
    {&Rewriter::logarithm, "log(1 + x)", "log1p(x)"},
    {&Rewriter::squares, "x * x - y * y", "(x - y) * (x + y)"},
    {&Rewriter::quadratic, "(-b + sqrt(b * b - 4 * a * c)) / (2 * a)",
     "-2 * c / (b + sqrt(b * b - 4 * a * c))"},
    {&Rewriter::variance, "the mean of squares less the square of the mean m",
     "the mean of (x - m) * (x - m)"},
};

}  // namespace

std::vector<Candidate> candidates(Graph& graph, NodeId output, const Options& options) {
  std::vector<Candidate> all;
  for (const Row& row : rows) {
    try {
      const std::optional<NodeId> rewritten = Rewriter(graph, options).rewrite(output, row.rule);
      if (rewritten && *rewritten != output) all.push_back({row.from, row.to, *rewritten});
    } catch (const NotBounded&) {
      // A function that the other formula needs has no known bound on this target.
    }
  }
  return all;
}

}  // namespace skc::bounds
