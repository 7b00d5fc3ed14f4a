// SPDX-License-Identifier: MIT
#include "bounds/folds.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "sk/sum_bounds.hpp"

namespace skc::bounds {
namespace {

enum class Kind : std::uint8_t { None, Sum, Min, Max };

struct Part {
  Kind kind = Kind::None;
  NodeId node = noNode;  ///< what is added or compared; noNode for an element that contributes nothing
  int terms = 0;
  NodeId magnitude = noNode;  ///< of a sum: the sum of the magnitudes of its terms
};

[[noreturn]] void refuse(Loc loc) {
  throw NotBounded("the fold neither adds its elements nor takes the smallest or largest of them", loc);
}

/// Finds what `node` adds to `before`.
class TermFinder {
 public:
  TermFinder(Graph& graph, NodeId before, Loc loc) : graph_(graph), before_(before), loc_(loc) {}

  Part partOf(NodeId id) {
    if (id == before_) return {};
    const Node node = graph_[id];
    const NodeId a = node.operands[0], b = node.operands[1];
    if (node.op == Op::Select) return chosen(node);
    const bool isSum = node.op == Op::Add || node.op == Op::Subtract;
    if (!isSum && node.op != Op::Min && node.op != Op::Max) refuse(loc_);
    const bool isFirst = depends(a);
    if (isFirst == depends(b) || (node.op == Op::Subtract && !isFirst)) refuse(loc_);
    const Part inner = partOf(isFirst ? a : b);
    NodeId other = isFirst ? b : a;
    if (node.op == Op::Subtract)
      other = graph_.add({.op = Op::Negate, .operands = {other, noNode, noNode}, .loc = node.loc});
    const Kind kind = isSum ? Kind::Sum : node.op == Op::Min ? Kind::Min : Kind::Max;
    if (inner.kind != Kind::None && inner.kind != kind) refuse(loc_);
    const NodeId magnitude =
        graph_.add({.op = Op::Absolute, .operands = {other, noNode, noNode}, .loc = node.loc});
    return {kind, joined(kind, inner.node, other), inner.terms + 1,
            joined(Kind::Sum, inner.magnitude, magnitude)};
  }

 private:
  bool depends(NodeId id) const {
    const std::vector<NodeId> needed = graph_.neededBy({id});
    return std::ranges::binary_search(needed, before_);
  }

  NodeId joined(Kind kind, NodeId a, NodeId b) {
    if (a == noNode) return b;
    const Op op = kind == Kind::Sum ? Op::Add : kind == Kind::Min ? Op::Min : Op::Max;
    return graph_.add({.op = op, .operands = {a, b, noNode}, .loc = graph_[b].loc});
  }

  Part chosen(const Node& node) {
    if (depends(node.operands[0])) refuse(loc_);
    Part yes = partOf(node.operands[1]), no = partOf(node.operands[2]);
    if (yes.kind == Kind::None && no.kind == Kind::None) return {};
    const Kind kind = yes.kind == Kind::None ? no.kind : yes.kind;
    if (yes.kind != Kind::None && no.kind != Kind::None && yes.kind != no.kind) refuse(loc_);
    const int terms = std::max(yes.terms, no.terms);
    // A sum to which an element adds nothing gets 0; of the others, the side that contributes bounds both.
    if (kind == Kind::Sum) {
      const NodeId zero = graph_.constant(0);
      const NodeId one = graph_.select(node.operands[0], yes.node == noNode ? zero : yes.node,
                                       no.node == noNode ? zero : no.node, node.loc);
      const NodeId magnitude = graph_.select(node.operands[0], yes.magnitude == noNode ? zero : yes.magnitude,
                                             no.magnitude == noNode ? zero : no.magnitude, node.loc);
      return {kind, one, terms, magnitude};
    }
    if (yes.node == noNode) return no;
    if (no.node == noNode) return yes;
    return {kind, graph_.select(node.operands[0], yes.node, no.node, node.loc), terms, yes.magnitude};
  }

  Graph& graph_;
  NodeId before_;
  Loc loc_;
};

sk::Precision precisionOf(Precision precision) {
  switch (precision) {
    case Precision::Single: return sk::Precision::Single;
    case Precision::Half: return sk::Precision::Half;
    case Precision::Extended: return sk::Precision::Extended;
    case Precision::Double: return sk::Precision::Double;
  }
  return sk::Precision::Single;
}

/// How a call adds that says nothing about it: with compensation, if skc knows the sum for one.
sk::Accumulate accumulateOf(const ir::Kernel& kernel, std::uint32_t accumulator) {
  const auto declared = static_cast<sk::Accumulate>(kernel.choices.accumulate);
  const auto isIt = [&](const auto& sum) { return sum.accumulator == accumulator; };
  const ir::Reduction* const reduction = kernel.reduction ? &*kernel.reduction : nullptr;
  const bool isCompensated = reduction != nullptr && reduction->compensated &&
                             std::ranges::any_of(reduction->compensated->sums, isIt);
  const bool isExact = reduction != nullptr && std::ranges::any_of(reduction->exact, isIt);
  if (declared == sk::Accumulate::Exact && isExact) return declared;
  if (declared == sk::Accumulate::Tree || declared == sk::Accumulate::Extended) return declared;
  return isCompensated ? sk::Accumulate::Compensated : sk::Accumulate::Tree;
}

}  // namespace

FoldTerm foldTerm(Graph& graph, NodeId after, NodeId before, Loc loc) {
  const Part part = TermFinder(graph, before, loc).partOf(after);
  if (part.kind == Kind::None) return {graph.constant(0), true, 1, graph.constant(0)};
  return {part.node, part.kind == Kind::Sum, part.terms, part.magnitude};
}

FoldBound boundOfFold(const FoldFacts& facts, const ir::Kernel& kernel, const Options& options) {
  if (!facts.term.isSum) {
    // The smallest of computed numbers is as far from the smallest exact one as the farthest of them, at most.
    return {facts.range, facts.error, std::nullopt};
  }
  if (options.elements == 0) {
    throw NotBounded(
        fmt::format("each element adds a term within {:.4g} to {:.4g}, with an error of at most {:.3g}; "
                    "say of how many elements the sum is: --elements N",
                    facts.range.low, facts.range.high, facts.error),
        kernel.loc);
  }
  if (options.precision == Precision::Half) throw NotBounded("a sum in half precision", kernel.loc);
  const double n = options.elements;
  // Computed terms are larger by their errors.
  const double largest = sumUp(facts.magnitude, facts.error);
  sk::SumFacts sum;
  sum.accumulate = accumulateOf(kernel, facts.accumulator);
  sum.precision = precisionOf(options.precision);
  sum.isScan = kernel.isScan;
  sum.elements = n;
  sum.terms = n * facts.term.terms;
  sum.magnitude = n * largest;
  sum.sum = n * sumUp(facts.range.magnitude(), facts.error);
  sum.areDoubles = facts.type == ir::Scalar::Double;
  sk::SummingDevice device;
  device.isNative = options.target == Target::Native;
  device.flushesDenormals = device.hasPairs = device.isDispatched = !device.isNative;
  const double own = sum.accumulate == sk::Accumulate::Exact && !sum.areDoubles ? 0x1p-24 * sum.magnitude
                                                                                : sk::boundOfSum(sum, device);
  const double absolute = roundedUp(n * facts.error + own, 0x1p-48);
  const Interval count = Interval::point(n);
  FoldBound bound{facts.range * count, absolute, std::nullopt};
  if (kernel.isScan) bound.range = hull(bound.range, facts.range);  // sums of the first elements
  if (!bound.range.contains(0)) bound.relative = roundedUp(absolute / bound.range.smallest());
  return bound;
}

}  // namespace skc::bounds
