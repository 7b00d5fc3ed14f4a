// SPDX-License-Identifier: MIT
//
// The program of one pass of a reduction: each fragment folds a run of elements, or of the partial
// results of the pass before, in row-major order, from its first one or from the identity. Which
// passes a reduction takes, and the values of their uniforms, is reduce_plan.hpp's business.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// What a run steps through.
enum class Walk : std::uint8_t {
  Line,      ///< a linearised stream whose blocks are consecutive elements
  Plane,     ///< a 2-D texture, a block being a rectangle of it
  Box,       ///< a linearised stream, a block being a box of up to 4 axes
  Index,     ///< elements by their index, wherever each input has its own
  Rows,  ///< rows of a 2-D texture, of which a run is a rectangle, in order a part of a row or whole rows; to one block
  Partials,  ///< the partial results of the pass before
  PartialRows,  ///< those that lie as Rows has left them
  GroupedPartials,  ///< those again, of any pass to one block, by a work group for each result
  Nothing,  ///< no element at all: the identities
};

/// Whether what is folded are partial results, by the combining kernel.
constexpr bool isOfPartials(Walk walk) {
  return walk == Walk::Partials || walk == Walk::PartialRows || walk == Walk::GroupedPartials;
}

/// Invocations of a work group that folds partial results together, as a row or a square.
inline constexpr std::int32_t groupSize = 256;
inline constexpr std::int32_t groupSide = 16;

/// How many runs and blocks there are; a block is what one element of the result folds.
enum class Runs : std::uint8_t {
  OneBlock,  ///< any number of runs over a single block (a reduction to a value)
  WholeBlocks,  ///< one run a block: the run of the output element under the fragment
  Split,  ///< several runs a block
};

/// One program of a reduction. Passes with equal variants share it. Where the walk is one of partial results or Nothing,
/// `access` says nothing of inputs; where it is Index, none is aligned; else all are, and lie alike.
struct ReduceVariant {
  Walk walk = Walk::Line;
  Runs runs = Runs::OneBlock;
  Domain domain = Domain::Linear;
  bool domainView = false;  ///< Domain::Plane: the domain's origin is not (0, 0)
  std::uint8_t domainRank = 1;  ///< Domain::LinearBox: rank of its stream
  std::uint8_t axes = 1;  ///< Walk::Box and Walk::Index
  std::uint8_t run =
      0;  ///< Walk::Rows: texels of a run, where all have as many, of one row or column; else 0
  bool column = false;  ///< Walk::Rows: runs are parts of columns, the last of which may have a texel more
  std::uint8_t part = 0;  ///< Walk::Rows, columns: texels that are folded by themselves, and then combined;
  ///< a run that is known has a multiple. 0: a run has no parts
  bool grouped = false;  ///< Walk::Rows: a work group combines what its invocations have
  bool strided =
      false;  ///< Walk::GroupedPartials: an invocation takes every groupSize-th, not one after the other
  bool toBuffer = false;  ///< the result is one element, and goes to a buffer (ProgramText::storeInBuffer())
  bool packed = false;  ///< walks of elements: the inputs are packed, and a step is one of whole texels
  bool sourceLayered = false;  ///< what is read, but for Walk::Index
  bool domainLayered = false;
  bool reshaped = false;  ///< the result's dimensions are not those of the blocks
  std::uint8_t firstPlane = 0;  ///< of those of all accumulators: the first that is written,
  std::uint8_t planeCount = 0;  ///< and how many; 0 is all of them
  std::vector<StreamAccess> access = {};  ///< one a parameter of `fold`, for partial results of `combine`;
      ///< or none, where there are no gathers, iterators and indices
  SpecValues specs{};  ///< of the same
  auto operator<=>(const ReduceVariant&) const = default;
};

/// The fragment program. Its samplers are samplerName() of the inputs of `fold`, for partial results of
/// `combine`, and of gathers; its outputs the accumulators' planes, in their order, from location 0, or from the beginning of the
/// buffer of binding 0, 16 bytes each. The
/// names of its integer uniforms are those that the plan gives values for; all that belong to a parameter
/// are those of a kernel's program (assemble.hpp).
std::string reduceProgram(const Profile& profile, const program::Reduction& reduction,
                          const ReduceVariant& variant);

}  // namespace sk::assemble
