// SPDX-License-Identifier: MIT
//
// Branch and bound: splits a box of inputs, and the ways of comparisons, until the largest value of an objective is known closely
// enough, or the budget is spent. The result is an upper bound in either case.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bounds/evaluator.hpp"
#include "bounds/interval.hpp"

namespace skc::bounds {

/// What the search maximises.
enum class Objective : std::uint8_t {
  Error,
  RelativeError,  ///< error over the magnitude of the exact result
  Largest,  ///< exact result
  Smallest,  ///< its negative
  Jump,  ///< Evaluator::jumpOf
};

struct SearchOptions {
  std::size_t boxes = 20'000;  ///< at most
  double tolerance = 0.01;  ///< relative, between the bound and a value that occurs
};

struct SearchResult {
  double bound = 0;  ///< no input gives more
  double found = 0;  ///< some input gives this
  std::size_t boxes = 0;
  std::vector<Interval> worst;  ///< the box with the largest bound
  std::vector<Decision> decisions;  ///< its decisions
  Problem problem = Problem::None;  ///< why the bound is infinite
  NodeId culprit = noNode;
};

/// `which`: of Objective::Jump.
SearchResult maximise(Evaluator& evaluator, const Graph& graph, Objective objective,
                      const SearchOptions& options, const std::vector<NodeId>& which = {});

}  // namespace skc::bounds
