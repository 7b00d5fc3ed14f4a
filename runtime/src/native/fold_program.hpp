// SPDX-License-Identifier: MIT
//
// The functions that fold the elements of one reduction: object code, or the runtime's own functions with the
// same ABI.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "native/call.hpp"
#include "native/fold_state.hpp"
#include "native/slot_arrays.hpp"
#include "sk/native/code.hpp"
#include "sk/program.hpp"

namespace sk {

/// The number of elements, or partial results, that are folded one after the other; at most
/// program::longestRun.
inline constexpr std::int64_t leafRounds = 16;

/// The number of accumulators that are folded side by side, so that they stay in registers.
inline std::int64_t sideOf(const StateShape& shape) { return shape.columnsIn(256, 16, 64); }
/// The number of neighbouring blocks that are folded side by side, so that they stay in the nearest cache
/// beside the elements.
inline std::int64_t groupOf(const StateShape& shape) { return shape.columnsIn(2048, 32, 512); }

/// A function, its lanes and its arguments.
template <class Function>
struct Bound {
  Function* function;
  std::int64_t lanes;
  const native::Frame* frame;
};

/// What all threads share. What it refers to must outlive it.
struct FoldProgram {
  const SlotLayout& layout;  ///< of the fold's slots
  const StateShape& shape;
  Bound<native::FoldFunction> fold;
  Bound<native::CombineFunction> combine;
  bool isCommutative;  ///< elements may be folded in any order
  bool isUneven;  ///< their times may differ widely
  native::Extents first{};  ///< the index of the first element that is folded
};

/// The destinations of the results of blocks.
class FoldResults {
 public:
  /// Uses the operands of the accumulators among the parameters, in their order.
  FoldResults(std::span<const program::Parameter> parameters, std::span<const native::Operand> operands,
              const StateShape& shape);

  /// Stores the results of `count` neighbouring blocks from `block` on, which are the columns from number `from` on.
  void store(const native::Extents& block, const StateColumns& columns, std::int64_t count,
             std::int64_t from = 0) const;

  /// True if all results are stored as they are, and neighbouring blocks' without gaps.
  bool areRows() const;
  /// True if all results are doubles that are stored as floats, and neighbouring blocks' without gaps.
  bool areRoundedRows() const;
  /// The address of a scalar of a block's result, if it is stored.
  std::byte* at(std::size_t scalar, const native::Extents& block) const;

 private:
  struct Array {
    std::byte* array;  ///< null if the result is omitted
    const native::Operand* operand;
    std::size_t bytes;  ///< of a scalar in the array
    bool isRounded;  ///< from a double to a float
  };
  std::vector<Array> arrays_;
};

/// Folds each block of a domain, which begins at program.first, to one element of the results.
void foldBlocks(const FoldProgram& program, const native::Extents& domain, const native::Extents& block,
                const FoldResults& results);

}  // namespace sk
