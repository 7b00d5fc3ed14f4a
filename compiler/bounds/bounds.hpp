// SPDX-License-Identifier: MIT
//
// Bounds the rounding errors of kernels: `skc --emit=bounds`. For each floating-point number that a kernel writes, a bound on the difference
// between what the device computes and what exact arithmetic gives for the same inputs, which no inputs within their ranges exceed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bounds/options.hpp"
#include "ir/ir.hpp"

namespace skc::bounds {

/// An operation, and how much of the bound it accounts for where the bound is largest.
struct Contribution {
  Loc loc;
  std::string text;
  double share;  ///< of 1
};

/// A condition that rounding errors may turn, and by how much the result then changes besides.
struct Jump {
  Loc loc;
  std::string text;
  double change;  ///< at most; infinite if unknown
};

/// Another way to compute the same, which has a smaller bound.
struct Rewrite {
  std::string from, to;
  double bound;
};

struct NumberBound {
  std::string name;  ///< "r", "r.x"
  std::string notBounded = {};  ///< why there is no bound; empty if there is one
  Loc loc = {};  ///< of what has no bound
  Interval range = {};  ///< of exact results
  double absolute = 0;
  std::optional<double> relative = {};  ///< if no result is 0
  std::vector<Contribution> contributions = {};  ///< the largest first
  std::vector<Jump> jumps = {};
  std::vector<Rewrite> rewrites = {};
  /// What each element contributes to a sum, a minimum or a maximum. The bounds above are of all elements, if their number is known.
  bool isFold = false;
};

struct KernelBounds {
  std::string name;  ///< with its namespaces
  std::string word;  ///< "kernel", "reduce", "scan"
  Precision precision = Precision::Single;
  std::string notBounded = {};
  Loc loc = {};
  std::vector<NumberBound> numbers = {};
};

/// Bounds all kernels that the program declares. The module has passed all transforms.
std::vector<KernelBounds> boundsOf(const ir::Module& module, const Options& options);
/// Bounds one of them.
KernelBounds boundsOf(const ir::Module& module, const ir::Kernel& kernel, const Options& options);

/// For people.
std::string listing(const std::vector<KernelBounds>& kernels, const Options& options);
/// The same as JSON; numbers that are not finite are null.
std::string json(const std::vector<KernelBounds>& kernels, const Options& options);

}  // namespace skc::bounds
