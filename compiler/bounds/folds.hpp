// SPDX-License-Identifier: MIT
//
// Reduces and scans that add their elements, or take the smallest or largest: what one element contributes, and the bound for all of them.
#pragma once

#include <cstdint>
#include <optional>

#include "bounds/graph.hpp"
#include "bounds/options.hpp"
#include "ir/ir.hpp"

namespace skc::bounds {

/// What an element adds to an accumulator.
struct FoldTerm {
  NodeId node;
  bool isSum;  ///< else the smallest or largest
  int terms;  ///< that one element adds, at most
  NodeId magnitude;  ///< the sum of their magnitudes
};

/// Throws NotBounded unless `after` adds numbers to `before`, or takes the smallest or the largest of it and a number.
FoldTerm foldTerm(Graph& graph, NodeId after, NodeId before, Loc loc);

struct FoldFacts {
  FoldTerm term;
  Interval range;  ///< of a term
  double error;  ///< bound for a term
  double magnitude;  ///< of the terms of an element, at most
  ir::Scalar type;
  std::uint32_t accumulator;  ///< its number among the kernel's parameters
};
struct FoldBound {
  Interval range;
  double absolute;
  std::optional<double> relative;
};

/// For Options::elements; throws NotBounded if a sum's number of elements is not known.
FoldBound boundOfFold(const FoldFacts& facts, const ir::Kernel& kernel, const Options& options);

}  // namespace skc::bounds
