// SPDX-License-Identifier: MIT
//
// Runs a kernel on symbols: every number is a node of a graph. Loops run until their condition is false, which must be known; both sides of
// a branch run, and what they assign differently becomes a Select. Throws NotBounded for what has no graph.
#pragma once

#include <string>
#include <vector>

#include "bounds/arithmetic.hpp"
#include "bounds/graph.hpp"
#include "bounds/options.hpp"
#include "ir/ir.hpp"

namespace skc::bounds {

/// A scalar of an output.
struct OutputNumber {
  std::string name;  ///< "r", "r.x", "hit.normal.y"
  std::uint32_t param;
  ir::Scalar type;  ///< that the stream holds
  NodeId node;  ///< of its arithmetic type
  bool isAccumulator = false;
  NodeId before = noNode;  ///< an accumulator's value before the element
  NodeId condition = noNode;  ///< under which the number is pushed or scattered; noNode: always
};

/// A kernel as a graph.
struct KernelGraph {
  Graph graph;
  std::vector<OutputNumber> outputs;
  /// The inputs without a range, by number of Graph::inputs().
  std::vector<bool> lacksRange;
  /// The expression, or the compound assignment, that each node comes from, by NodeId. Both are null for nodes that no single one stands
  /// for.
  struct Origin {
    const ir::Expr* expr = nullptr;
    ir::FunctionId function = 0;
    const ir::Assign* assignment = nullptr;
  };
  std::vector<Origin> origins;
};

KernelGraph graphOf(const ir::Module& module, const ir::Kernel& kernel, const Options& options);

}  // namespace skc::bounds
