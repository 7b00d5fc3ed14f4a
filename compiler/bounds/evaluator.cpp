// SPDX-License-Identifier: MIT
#include "bounds/evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace skc::bounds {
namespace {

constexpr Interval unknown = Interval::whole();

bool mayFail(const Node& node) {
  if (node.op == Op::Call2) return true;
  return node.op == Op::Call && !isDefined(node.function, Interval::whole());
}

}  // namespace

Evaluator::Evaluator(const Graph& graph, NodeId output, NodeId assumed)
    : graph_(graph),
      output_(output),
      assumed_(assumed),
      order_(graph.neededBy(assumed == noNode ? std::vector{output} : std::vector{output, assumed})),
      comparisonNumber_(graph.size(), 0),
      tracks_(graph.size(), false),
      slots_(graph.size()),
      limits_(graph.size(), unknown) {
  for (const NodeId id : order_) {
    const Node& node = graph_[id];
    if (isComparison(node.op)) {
      comparisonNumber_[id] = static_cast<std::uint32_t>(comparisons_.size());
      comparisons_.push_back(id);
    }
    if (isComparison(node.op) || isStep(node.op)) turns_.push_back(id);
    if (node.op == Op::Input) inputs_.push_back(node.index);
  }
  for (auto it = order_.rbegin(); it != order_.rend(); ++it) {
    const Node& node = graph_[*it];
    if (!tracks_[*it] && !mayFail(node)) continue;
    for (const NodeId operand : node.operands) {
      if (operand != noNode) tracks_[operand] = true;
    }
  }
}

// ---- backward -------------------------------------------------------------------------------------

void Evaluator::backward() {
  for (const NodeId id : order_) {
    slots_[id].adjoint = Interval::point(0);
    slots_[id].isLive = false;
  }
  slots_[output_].adjoint = Interval::point(1);
  slots_[output_].isLive = true;
  if (assumed_ != noNode && truthOf(assumed_) == Decision::Open) slots_[assumed_].isLive = true;
  for (auto it = order_.rbegin(); it != order_.rend(); ++it) {
    const Slot& slot = slots_[*it];
    if (!slot.isLive) continue;
    const Node& node = graph_[*it];
    if (isCondition(node.op)) {
      for (const NodeId operand : node.operands) {
        if (operand != noNode) slots_[operand].isLive = true;
      }
      continue;
    }
    for (std::size_t k = 0; k < 3 && node.operands[k] != noNode; ++k) {
      Slot& operand = slots_[node.operands[k]];
      const Interval slope = slot.slopes[k];
      if (node.op == Op::Select) {
        // A side that is not chosen does not count, nor does a condition that is decided.
        const bool isOpen = slots_[node.operands[0]].truth == Decision::Open;
        if (k == 0 ? !isOpen : slope.high == 0) continue;
      }
      operand.isLive = true;
      if (slope.low == 1 && slope.high == 1) {
        operand.adjoint = operand.adjoint + slot.adjoint;
      } else if (slope.low != 0 || slope.high != 0) {
        operand.adjoint = operand.adjoint + slot.adjoint * slope;
      }
    }
  }
}

BoxResult Evaluator::evaluate(std::span<const Interval> box, std::span<const Decision> decisions) {
  BoxResult result;
  if (hasLimits_) {
    std::ranges::fill(limits_, unknown);
    hasLimits_ = false;
  }
  forward(box, decisions);
  const bool isDecided = std::ranges::any_of(decisions, [](Decision d) { return d != Decision::Open; });
  if (isDecided) {
    // Two rounds: the first finds the limits, the second uses them.
    if (!limitByDecisions(decisions)) return result.isImpossible = true, result;
    if (hasLimits_) {
      forward(box, decisions);
      for (const NodeId id : order_) {
        if (!isCondition(graph_[id].op) && slots_[id].exact.isEmpty())
          return result.isImpossible = true, result;
      }
      if (!limitByDecisions(decisions)) return result.isImpossible = true, result;
    }
  }
  if (assumed_ != noNode && truthOf(assumed_) == Decision::No) return result.isImpossible = true, result;
  backward();
  const Slot& output = slots_[output_];
  result.value = output.exact;
  double sum = 0, count = 0;
  for (const NodeId id : order_) {
    const Slot& slot = slots_[id];
    if (!slot.isLive) continue;
    const Node& node = graph_[id];
    if (isComparison(node.op)) {
      if (slot.truth == Decision::Open && result.undecided == noNode) result.undecided = id;
      continue;
    }
    if (isCondition(node.op)) continue;
    if (slot.problem != Problem::None && result.problem == Problem::None) {
      result.problem = slot.problem;
      result.culprit = id;
    }
    if (slot.own == 0) continue;
    sum += productUp(slot.own, slot.adjoint.magnitude());
    ++count;
  }
  sum = roundedUp(sum, 0x1p-52 * (count + 1));
  result.error = result.problem != Problem::None ? infinity : std::min(sum, output.error);
  return result;
}

std::vector<Evaluator::Share> Evaluator::shares() const {
  std::vector<Share> shares;
  for (const NodeId id : order_) {
    const Slot& slot = slots_[id];
    if (!slot.isLive || isCondition(graph_[id].op) || slot.own == 0) continue;
    const double error = productUp(slot.own, slot.adjoint.magnitude());
    if (error > 0) shares.push_back({id, error});
  }
  return shares;
}

// ---- jumps ----------------------------------------------------------------------------------------

/// True if the computed operands may decide otherwise than the exact ones.
bool Evaluator::isTurned(NodeId id) const {
  const Node& node = graph_[id];
  const Slot& x = slots_[node.operands[0]];
  if (isStep(node.op)) {
    if (x.error == 0) return false;
    const Interval steps = stepped(node.op, x.between);
    return steps.low != steps.high;
  }
  const Slot& y = slots_[node.operands[1]];
  return slots_[id].truth == Decision::Open && (x.error > 0 || y.error > 0);
}

double Evaluator::jumpOf(std::span<const Interval> box, std::span<const Decision> decisions,
                         std::span<const NodeId> which) {
  turned_ = which;
  const BoxResult result = evaluate(box, decisions);
  turned_ = {};
  if (result.isImpossible) return 0;
  bool isAnyTurned = false;
  double jump = 0;
  for (const NodeId id : which) {
    if (!isTurned(id)) continue;
    isAnyTurned = true;
    const Slot& slot = slots_[id];
    if (isStep(graph_[id].op) && slot.isLive) {
      const Interval steps = stepped(graph_[id].op, slots_[graph_[id].operands[0]].between);
      jump += productUp(steps.width(), slot.adjoint.magnitude());
    }
  }
  if (!isAnyTurned) return 0;
  for (const NodeId id : order_) {
    const Node& node = graph_[id];
    const Slot& slot = slots_[id];
    if (node.op != Op::Select || !slot.isLive || slots_[node.operands[0]].truth != Decision::Open) continue;
    const Interval change = slots_[node.operands[1]].exact - slots_[node.operands[2]].exact;
    jump += productUp(change.magnitude(), slot.adjoint.magnitude());
  }
  if (result.problem != Problem::None) return infinity;
  return roundedUp(jump, 0x1p-40);
}

}  // namespace skc::bounds
