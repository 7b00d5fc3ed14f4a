// SPDX-License-Identifier: MIT
//
// Bounds the rounding error of one number of a graph for all inputs within a box.
//
// Let F(x, e) be the result for inputs x where operation i is off by e_i from the exact operation on its operands. By the mean value
// theorem, F(x, e) - F(x, 0) is the sum of dF/de_i (x, t e) * e_i for some t between 0 and 1. A box of inputs gives an interval of each
// derivative, by reverse mode, from intervals that contain all values on the way from the exact numbers to the computed ones; so the bound
// includes terms of every order, and no remainder is added. The first-order part is that of Solovyev, Jacobsen, Rakamaric and
// Gopalakrishnan, Rigorous Estimation of Floating-Point Round-off Errors with Symbolic Taylor Expansions (FM 2015).
//
// The bound assumes that comparisons, and functions such as floor, give for the computed numbers what they give for the exact ones. What
// the result changes by where they do not is jumpOf().
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bounds/graph.hpp"
#include "bounds/interval.hpp"

namespace skc::bounds {

enum class Problem : std::uint8_t {
  None,
  DivisionByZero,
  Undefined,  ///< a function where it has no value
  Overflow,
  IntegerOverflow,
};

enum class Decision : std::uint8_t { No, Yes, Open };

/// What a box says about the result.
struct BoxResult {
  bool isImpossible = false;  ///< no input of the box makes all decisions
  Interval value = {};
  double error = 0;  ///< infinite if there is no bound
  NodeId undecided = noNode;  ///< a comparison that matters and that the box leaves open
  Problem problem = Problem::None;  ///< why there is no bound
  NodeId culprit = noNode;  ///< where
};

/// The result of Floor and the like.
Interval stepped(Op op, Interval x);

class Evaluator {
 public:
  /// `assumed`: a condition that holds for all inputs that count.
  Evaluator(const Graph& graph, NodeId output, NodeId assumed = noNode);

  /// Comparisons, in the order of the decisions of a box.
  const std::vector<NodeId>& comparisons() const { return comparisons_; }
  /// Nodes of Select, Floor and the like whose operand, or condition, rounding errors may turn.
  const std::vector<NodeId>& turns() const { return turns_; }
  std::size_t nodeCount() const { return order_.size(); }
  /// The inputs that the result depends on.
  const std::vector<std::uint32_t>& inputs() const { return inputs_; }

  /// `box` has all inputs of the graph, `decisions` all comparisons.
  BoxResult evaluate(std::span<const Interval> box, std::span<const Decision> decisions);

  /// The largest change of the result where the device decides one of the comparisons (or steps) `which`, sorted, otherwise than the
  /// exact numbers do; 0 if no input of the box allows that.
  double jumpOf(std::span<const Interval> box, std::span<const Decision> decisions,
                std::span<const NodeId> which);

  /// After evaluate(): what each operation adds to the error; entries of 0 are left out.
  struct Share {
    NodeId node;
    double error;
  };
  std::vector<Share> shares() const;

 private:
  struct Slot {
    Interval exact;  ///< values of exact arithmetic
    Interval between;  ///< values between exact and computed ones
    Interval computed;  ///< computed values, as far as `tracks` asks for them, else `between`
    double error = 0;  ///< of the computed value
    double own = 0;  ///< error that the operation itself adds
    std::array<Interval, 3> slopes;
    Interval adjoint;
    Problem problem = Problem::None;
    Decision truth = Decision::Open;  ///< of conditions
    bool isLive = false;
  };

  void forward(std::span<const Interval> box, std::span<const Decision> decisions);
  bool limitByDecisions(std::span<const Decision> decisions);
  void visit(NodeId id, std::span<const Interval> box, std::span<const Decision> decisions);
  void visitCondition(NodeId id, std::span<const Decision> decisions);
  void visitSelect(const Node& node, Slot& slot);
  void visitCall(const Node& node, Slot& slot);
  void finish(NodeId id, const Node& node, Slot& slot);
  Interval extremeOf(const Node& node) const;
  double directErrorOf(const Node& node, const Slot& slot, double propagated) const;
  double roundingOf(const Node& node, Interval unrounded) const;
  Interval withSigns(Interval range, const Node& node) const;
  Interval computedOf(const Node& node, const Slot& slot) const;
  void backward();
  bool isTurned(NodeId id) const;
  Decision truthOf(NodeId condition) const;

  const Graph& graph_;
  NodeId output_, assumed_;
  std::vector<NodeId> order_;
  std::vector<NodeId> comparisons_, turns_;
  std::vector<std::uint32_t> inputs_;
  std::vector<std::uint32_t> comparisonNumber_;  ///< by node
  std::vector<bool> tracks_;  ///< nodes whose computed values decide whether a function is defined
  std::vector<Slot> slots_;
  std::vector<Interval> limits_;  ///< what decisions say about values, by node
  bool hasLimits_ = false;
  std::span<const NodeId> turned_;  ///< comparisons whose result for computed numbers counts, in jumpOf()
};

}  // namespace skc::bounds
