// SPDX-License-Identifier: MIT
//
// The program of one pass of a reduction: each fragment folds a run of elements, or of the previous pass's
// partial results, in row-major order, starting from the first one or from the identity. reduce_plan.hpp
// plans passes and computes the values of their uniforms.
//
// Names of walks and runs, for the first comment of a reduction's program.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// What a run iterates over.
enum class Walk : std::uint8_t {
  Line,      ///< a linearised stream whose blocks are consecutive elements
  Plane,  ///< a 2-D texture whose blocks are rectangles
  Box,  ///< a linearised stream whose blocks are boxes of up to 4 axes
  Index,  ///< elements by index, with any layout of each input
  /// Rows of a 2-D texture, in one block. A run is a rectangle; if order matters, a part of a row or whole
  /// rows.
  Rows,
  Partials,  ///< partial results of the previous pass
  PartialRows,  ///< partial results in the layout of Rows
  GroupedPartials,  ///< partial results of any pass over one block; a work group computes each result
  Nothing,  ///< no elements: the identities
};

/// Whether it folds partial results, with the combining kernel.
constexpr bool isOfPartials(Walk walk) {
  return walk == Walk::Partials || walk == Walk::PartialRows || walk == Walk::GroupedPartials;
}

/// The invocations of a work group that folds partial results together, as a row or a square.
inline constexpr std::int32_t groupSize = 256;
inline constexpr std::int32_t groupSide = 16;

/// The numbers of runs and blocks. A block is folded to one element of the result.
enum class Runs : std::uint8_t {
  OneBlock,  ///< any number of runs in a single block (a reduction to a value)
  WholeBlocks,  ///< one run per block: the run of the fragment's output element
  Split,  ///< several runs per block
};

/// What a pass of a scan computes (scan_plan.hpp).
enum class ScanPass : std::uint8_t {
  None,  ///< it belongs to a reduction
  Folds,  ///< one result for each run
  Inclusive,  ///< one for each item: those of its run up to it, after the runs before
  Exclusive,  ///< the same without the item
};

/// What an invocation of a pass of a scan computes (scan_plan.hpp).
enum class ScanUnit : std::uint8_t {
  Item,  ///< one result; it folds the items before it in its run again
  Run,  ///< all results of a run
  Tile,  ///< those of a run, which is one of a work group's tile: the group combines the results of its runs
};

/// What a pass over rows of different lengths computes (row_program.hpp).
enum class RowPass : std::uint8_t {
  None,  ///< it has nothing to do with rows
  Folds,  ///< one result for each piece of a row
  Groups,  ///< the same; a work group folds several pieces together; packed: all inputs begin at the same lane
  Inclusive,  ///< scans: one result for each item, up to it
  Exclusive,  ///< the same without the item
};

/// One program of a reduction or a scan, which passes with equal variants share. For walks of partial results and for
/// Nothing, `access` does not describe inputs. For Index, no input is aligned; for other walks, all are
/// aligned and have one layout.
struct ReduceVariant {
  Walk walk = Walk::Line;
  Runs runs = Runs::OneBlock;
  Domain domain = Domain::Linear;
  bool domainView = false;  ///< Domain::Plane: the domain's origin is not (0, 0)
  std::uint8_t domainRank = 1;  ///< Domain::LinearBox: rank of its stream
  std::uint8_t axes = 1;  ///< Walk::Box and Walk::Index
  /// Walk::Rows: texels of a run, if all runs have the same number, of one row or column; else 0. Scans: the items of a
  /// run.
  std::uint8_t run = 0;
  bool column = false;  ///< Walk::Rows: runs are parts of columns; the last may be longer by one texel
  /// Walk::Rows, columns: texels that are folded separately and then combined; a known run is a multiple of
  /// it. 0: runs have no parts.
  std::uint8_t part = 0;
  bool grouped = false;  ///< Walk::Rows: a work group combines the results of its invocations
  /// A work group folds two blocks, one above the other, whose results it stores apart: invocations side by side read texels
  /// of both, as Function::Paired has them.
  bool twoBlocks = false;
  /// Walk::GroupedPartials: an invocation folds every groupSize-th partial result, not consecutive ones.
  bool strided = false;
  bool toBuffer = false;  ///< the only element of the result goes to a buffer (ProgramText::storeInBuffer())
  bool packed = false;  ///< walks of elements: the inputs are packed, and a step is a whole texel
  bool sourceLayered = false;  ///< of what is read, except for Walk::Index
  bool domainLayered = false;
  ScanPass scan = ScanPass::None;
  ScanUnit unit = ScanUnit::Item;
  /// ScanUnit::Tile: the only pass; its groups share a buffer at binding 0, which is 0 at first: two words, then two for each
  /// accumulator and tile.
  bool chained = false;
  /// Scans of the terms of an exact sum (sk/exact_digits.hpp). Items of partial results are combined with the identities,
  /// even where they could start a run, so that every result has been combined; rows settle digits that have no more room.
  bool ofDigits = false;
  bool carried = false;  ///< scans: reads the results of the runs before
  bool carryLayered = false;  ///< of these
  RowPass rows = RowPass::None;
  bool tableLayered = false;  ///< rows: of the first table
  bool placed = false;  ///< Walk::Index: elements are a box of a whole, in which the fold's indices count
  bool reshaped = false;  ///< the result has other dimensions than the grid of blocks
  std::uint8_t firstPlane = 0;  ///< among the planes of all accumulators: the first one written,
  std::uint8_t planeCount = 0;  ///< and how many; 0 means all
  /// One per parameter of `fold`, or of `combine` for partial results; empty if there are no gathers,
  /// iterators and indices.
  std::vector<StreamAccess> access = {};
  SpecValues specs{};  ///< of the same kernel
  auto operator<=>(const ReduceVariant&) const = default;
};

/// The fragment program. Its samplers are samplerName() of the inputs of `fold`, or of `combine` for partial
/// results, and of gathers. Its outputs are the accumulators' planes, in order, from location 0 or from the
/// beginning of the buffer at binding 0, 16 bytes each. The plan gives values for its integer uniforms, by
/// name; a parameter's own uniforms are those of a kernel's program (assemble.hpp).
std::string reduceProgram(const Profile& profile, const program::Reduction& reduction,
                          const ReduceVariant& variant);

std::string_view nameOf(Walk walk);
std::string_view nameOf(Runs runs);

}  // namespace sk::assemble
