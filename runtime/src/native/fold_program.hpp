// SPDX-License-Identifier: MIT
//
// What folds the elements of one reduction: functions of object code, or of the runtime itself, which keep to the same ABI.
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

/// Elements, or partial results, that are folded one after the other; program::longestRun at most.
inline constexpr std::int64_t leafRounds = 16;

/// Accumulators that are folded side by side, so that they stay in registers.
inline std::int64_t sideOf(const StateShape& shape) { return shape.columnsIn(256, 16, 64); }
/// Neighbouring blocks that are folded side by side, so that they stay in the nearest cache beside the elements.
inline std::int64_t groupOf(const StateShape& shape) { return shape.columnsIn(2048, 32, 512); }

/// A function with its lanes and its arguments.
template <class Function>
struct Bound {
  Function* function;
  std::int64_t lanes;
  const native::Frame* frame;
};

/// All that threads share. What it refers to must outlive it.
struct FoldProgram {
  const SlotLayout& layout;  ///< of the fold's slots
  const StateShape& shape;
  Bound<native::FoldFunction> fold;
  Bound<native::CombineFunction> combine;
  bool isCommutative;  ///< elements may be folded in any order
  bool isUneven;  ///< they may take very different times
};

/// Where the results of blocks go.
class FoldResults {
 public:
  /// The operands of the accumulators among the parameters, in their order.
  FoldResults(std::span<const program::Parameter> parameters, std::span<const native::Operand> operands,
              const StateShape& shape);

  /// Of `count` neighbouring blocks from `block` on: the first columns.
  void store(const native::Extents& block, const StateColumns& columns, std::int64_t count) const;

 private:
  struct Array {
    std::byte* array;  ///< null where the result is left out
    const native::Operand* operand;
    std::size_t bytes;
  };
  std::vector<Array> arrays_;
};

/// Folds each block of a domain to one element of the results.
void foldBlocks(const FoldProgram& program, const native::Extents& domain, const native::Extents& block,
                const FoldResults& results);

}  // namespace sk
