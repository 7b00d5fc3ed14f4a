// SPDX-License-Identifier: MIT
#include "bounds/search.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>

namespace skc::bounds {
namespace {

struct Box {
  std::vector<Interval> sides;  ///< of all inputs
  std::vector<Decision> decisions;
  std::vector<double> impacts;  ///< what halving each side of `inputs` would take off the bound, roughly
  double bound = 0;
  int depth = 0;
  NodeId undecided = noNode;
  Problem problem = Problem::None;
  NodeId culprit = noNode;
};

class Search {
 public:
  Search(Evaluator& evaluator, const Graph& graph, Objective objective, const SearchOptions& options,
         const std::vector<NodeId>& which)
      : evaluator_(evaluator), graph_(graph), objective_(objective), options_(options), which_(which) {}

  SearchResult run() {
    Box root;
    for (const Input& input : graph_.inputs()) root.sides.push_back(input.range);
    root.decisions.assign(evaluator_.comparisons().size(), Decision::Open);
    result_.found = -infinity;
    add(std::move(root));
    // Where a tenth of the budget leaves no bound, more will not.
    std::size_t unbounded = 0;
    while (!queue_.empty() && result_.boxes < options_.boxes && !isClose(queue_.front().bound)) {
      if (!(queue_.front().bound < infinity) && ++unbounded > options_.boxes / 20) break;
      split(take());
    }
    finish(!queue_.empty() && !(queue_.front().bound < final_.bound) ? queue_.front() : final_);
    return std::move(result_);
  }

 private:
  static Box nothing() {
    Box box;
    box.bound = -infinity;
    return box;
  }

  static bool isLess(const Box& a, const Box& b) { return a.bound < b.bound; }

  bool isClose(double bound) const {
    return bound <= result_.found + options_.tolerance * std::fabs(result_.found) || bound <= final_.bound;
  }

  void finish(const Box& box) {
    result_.bound = std::max(box.bound, result_.found);  // boxes below what was found have been dropped
    if (box.sides.empty()) return;
    result_.worst = box.sides;
    result_.decisions = box.decisions;
    result_.problem = box.problem;
    result_.culprit = box.culprit;
  }

  Box take() {
    std::ranges::pop_heap(queue_, isLess);
    Box box = std::move(queue_.back());
    queue_.pop_back();
    return box;
  }

  /// Bounds the objective in a box. Returns false if no input is in it.
  bool evaluate(Box& box) {
    ++result_.boxes;
    if (objective_ == Objective::Jump) {
      box.bound = evaluator_.jumpOf(box.sides, box.decisions, which_);
      box.problem = box.bound < infinity ? Problem::None : Problem::Undefined;
      return box.bound > 0;
    }
    const BoxResult result = evaluator_.evaluate(box.sides, box.decisions);
    box.undecided = result.undecided;
    box.problem = result.problem;
    box.culprit = result.culprit;
    switch (objective_) {
      case Objective::Error: box.bound = result.error; break;
      case Objective::RelativeError:
        box.bound = result.error == 0 ? 0 : roundedUp(result.error / result.value.smallest());
        break;
      case Objective::Largest: box.bound = result.value.high; break;
      case Objective::Smallest: box.bound = -result.value.low; break;
      case Objective::Jump: break;
    }
    return !result.isImpossible;
  }

  void add(Box box) {
    if (!evaluate(box) || box.bound <= result_.found) return;
    queue_.push_back(std::move(box));
    std::ranges::push_heap(queue_, isLess);
  }

  /// Tries the middle of a box, whose value no bound may be below.
  void probe(const Box& box) {
    Box middle = box;
    for (const std::uint32_t input : evaluator_.inputs()) {
      Interval& side = middle.sides[input];
      double at = side.middle();
      if (isInteger(input)) at = std::floor(at);
      side = Interval::point(std::clamp(at, side.low, side.high));
    }
    // Where decisions are open at a point, its bound is one for both ways, which may not occur.
    if (evaluate(middle) && middle.undecided == noNode && middle.bound > result_.found &&
        middle.bound < infinity)
      result_.found = middle.bound;
  }

  bool isInteger(std::uint32_t input) const { return graph_.inputs()[input].isInteger; }

  bool isDivisible(std::uint32_t input, Interval side) const {
    if (isInteger(input)) return side.low < side.high;
    const double middle = side.middle();
    return side.low < middle && middle < side.high;
  }

  void split(Box box) {
    if (objective_ != Objective::Jump) probe(box);
    if (isClose(box.bound)) return settle(std::move(box));
    const auto dimensions = static_cast<int>(evaluator_.inputs().size());
    const bool isFine = box.depth >= 2 * dimensions || !(box.bound < infinity);
    if (objective_ != Objective::Jump && box.undecided != noNode && (isFine || !hasDivisibleSide(box)))
      return decide(std::move(box));
    measureImpacts(box);
    halve(std::move(box));
  }

  bool hasDivisibleSide(const Box& box) const {
    return std::ranges::any_of(evaluator_.inputs(),
                               [&](std::uint32_t input) { return isDivisible(input, box.sides[input]); });
  }

  /// Keeps a box that cannot be split for the result.
  void settle(Box box) {
    if (!(box.bound < final_.bound)) final_ = std::move(box);
  }

  void decide(Box box) {
    const auto& comparisons = evaluator_.comparisons();
    const auto at =
        static_cast<std::size_t>(std::ranges::find(comparisons, box.undecided) - comparisons.begin());
    Box other = box;
    box.decisions[at] = Decision::Yes;
    other.decisions[at] = Decision::No;
    add(std::move(box));
    add(std::move(other));
  }

  void measureImpacts(Box& box) {
    const std::vector<std::uint32_t>& inputs = evaluator_.inputs();
    if (inputs.size() == 1 || (!box.impacts.empty() && box.depth % 4 != 0)) return;
    box.impacts.assign(inputs.size(), 0);
    if (!(box.bound < infinity)) {
      for (std::size_t k = 0; k < inputs.size(); ++k) {
        const double whole = graph_.inputs()[inputs[k]].range.width();
        box.impacts[k] = whole > 0 ? box.sides[inputs[k]].width() / whole : 0;
      }
      return;
    }
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      const Interval side = box.sides[inputs[k]];
      if (!isDivisible(inputs[k], side)) continue;
      Box trial = box;
      trial.sides[inputs[k]] = Interval::point(side.middle());
      const double bound = box.bound == 0 ? 1 : std::fabs(box.bound);
      // A plane through the middle may have nothing of what counts, such as a threshold.
      box.impacts[k] = evaluate(trial) ? std::max((box.bound - trial.bound) / bound, 0.0)
                                       : side.width() / graph_.inputs()[inputs[k]].range.width();
    }
  }

  void halve(Box box) {
    const std::vector<std::uint32_t>& inputs = evaluator_.inputs();
    const auto share = [&](std::size_t k) {
      return box.sides[inputs[k]].width() / graph_.inputs()[inputs[k]].range.width();
    };
    double widest = 0;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (isDivisible(inputs[k], box.sides[inputs[k]])) widest = std::max(widest, share(k));
    }
    std::size_t best = inputs.size();
    double most = -1;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (!isDivisible(inputs[k], box.sides[inputs[k]])) continue;
      // Wide sides count without impact, too: several may have to shrink before the bound does.
      const double weight = (box.impacts.empty() ? 0 : box.impacts[k]) + 0.05 * share(k) / widest;
      if (weight > most) {
        most = weight;
        best = k;
      }
    }
    if (best == inputs.size()) return settle(std::move(box));
    const std::uint32_t input = inputs[best];
    const Interval side = box.sides[input];
    const double middle = isInteger(input) ? std::floor(side.middle()) : side.middle();
    if (!box.impacts.empty()) box.impacts[best] /= 2;
    ++box.depth;
    Box upper = box;
    box.sides[input] = {side.low, middle};
    upper.sides[input] = {isInteger(input) ? middle + 1 : middle, side.high};
    add(std::move(box));
    add(std::move(upper));
  }

  Evaluator& evaluator_;
  const Graph& graph_;
  const Objective objective_;
  const SearchOptions options_;
  const std::vector<NodeId>& which_;
  std::vector<Box> queue_;  // a heap
  Box final_ = nothing();  // the largest of those that are done
  SearchResult result_;
};

}  // namespace

SearchResult maximise(Evaluator& evaluator, const Graph& graph, Objective objective,
                      const SearchOptions& options, const std::vector<NodeId>& which) {
  return Search(evaluator, graph, objective, options, which).run();
}

}  // namespace skc::bounds
