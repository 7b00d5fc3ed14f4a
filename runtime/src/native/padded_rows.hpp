// SPDX-License-Identifier: MIT
//
// Copies of gathers whose rows lie a multiple of half a page apart. Elements below each other in such a matrix share a
// few sets of the caches, so that a column of it evicts itself: a product of matrices of 1024 x 1024 took twice as
// long as one of 1056 x 1056. In the copy, each row begins two cache lines later than the row before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "native/call.hpp"
#include "native/column_panels.hpp"
#include "native/memory.hpp"
#include "native/slot_arrays.hpp"
#include "sk/program.hpp"

namespace sk {

/// The copies for one call of a RunRows entry: those gathers that all of its rows read (Code::sharedGathers), if
/// enough blocks of rows read them to make up for the copy, and which have no panels.
class PaddedRows {
 public:
  /// `rows` is the number of rows that the entry computes together. What the operands point to must outlive this.
  PaddedRows(const program::Kernel& kernel, const native::Call& call, std::int64_t rows,
             const ColumnPanels& panels);

  bool isEmpty() const { return copies_.empty(); }
  /// Copies the gathers' elements, on all threads, and lets the frame read the copies. Throws NoMemory.
  void copyInto(CodeFrame& frame);

 private:
  struct Copy {
    std::size_t parameter;
    native::Operand from;
    std::vector<std::size_t> bytes;  ///< of each scalar
    native::Extents stride;  ///< of the copy
    std::vector<ArrayMemory> memory;
    std::vector<void*> arrays;
  };
  static void copyRows(const Copy& copy, std::size_t scalar);

  std::vector<Copy> copies_;
};

}  // namespace sk
