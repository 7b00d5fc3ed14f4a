// SPDX-License-Identifier: MIT
//
// The program of one pass of a reduction: each fragment folds a run of elements, or of the partial
// results of the pass before, in row-major order, from its first one or from the identity. Which
// passes a reduction takes, and the values of their uniforms, is reduce_plan.hpp's business.
#pragma once

#include <cstdint>
#include <string>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// What a run steps through.
enum class Walk : std::uint8_t {
  Line,      ///< a linearised stream whose blocks are consecutive elements
  Plane,     ///< a 2-D texture, a block being a rectangle of it
  Box,       ///< a linearised stream, a block being a box of up to 4 axes
  Partials,  ///< the partial results of the pass before
};

/// How many runs and blocks there are; a block is what one element of the result folds.
enum class Runs : std::uint8_t {
  OneBlock,    ///< any number of runs over a single block (a reduction to a value)
  WholeBlocks, ///< one run a block: the run of the output element under the fragment
  Split,       ///< several runs a block
};

/// One program of a reduction. Passes with equal variants share it.
struct ReduceVariant {
  Walk walk = Walk::Line;
  Runs runs = Runs::OneBlock;
  Domain domain = Domain::Linear;
  bool domainView = false;       ///< Domain::Plane: the domain's origin is not (0, 0)
  std::uint8_t domainRank = 1;   ///< Domain::LinearBox: rank of its stream
  std::uint8_t axes = 1;         ///< Walk::Box
  auto operator<=>(const ReduceVariant&) const = default;
};

/// The fragment program. Its samplers are samplerName() of the fold's Input parameter, or of its
/// Accumulator parameter where the walk is Partials; its outputs are the accumulator's planes from
/// location 0; the names of its integer uniforms are those that the plan gives values for.
std::string reduceProgram(const Profile& profile, const program::Reduction& reduction,
                          const ReduceVariant& variant);

}  // namespace sk::assemble
