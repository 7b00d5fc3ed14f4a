// SPDX-License-Identifier: MIT
//
// Formulas that lose digits by cancellation, and others that have the same value without it.
#pragma once

#include <string>
#include <vector>

#include "bounds/graph.hpp"
#include "bounds/options.hpp"

namespace skc::bounds {

struct Candidate {
  std::string from, to;  ///< "sqrt(a) - sqrt(b)", "(a - b) / (sqrt(a) + sqrt(b))"
  NodeId output;  ///< with every place of this kind rewritten
};

/// Adds to the graph, for each kind of formula that occurs below `output`, the output with that formula rewritten.
std::vector<Candidate> candidates(Graph& graph, NodeId output, const Options& options);

}  // namespace skc::bounds
