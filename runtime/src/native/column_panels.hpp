// SPDX-License-Identifier: MIT
//
// Copies of gathers for products of matrices: panels of as many columns as code computes together, one row behind the
// other (K. Goto and R. van de Geijn, "Anatomy of high-performance matrix multiplication", 2008).
//
//   b: columns 0 ... n - 1 of row 0, then of row 1 ...     panels: columns 0 ... 31 of row 0, of row 1 ..., then columns 32 ... 63
//
// Code that walks down some columns of a matrix reads a panel in order. In the matrix itself, each row is in another page, and rows
// that lie a multiple of half a page apart share few sets of the caches.
#pragma once

#include <cstdint>
#include <vector>

#include "native/call.hpp"
#include "native/components.hpp"
#include "native/memory.hpp"
#include "sk/native/code.hpp"
#include "sk/native/parallel.hpp"
#include "sk/program.hpp"

namespace sk {

/// The panels for one call of a RunRows entry: of gathers that all of its rows read (Code::sharedGathers) and of which an
/// element reads only its own column, where the copy pays.
class ColumnPanels {
 public:
  /// `entry` may be null; there are no panels then. What the operands point to must outlive this.
  ColumnPanels(const program::Kernel& kernel, const native::Call& call, const native::Entry* entry);

  bool isEmpty() const { return gathers_.empty(); }
  bool has(std::size_t parameter) const;
  /// The columns of a panel.
  std::int64_t width() const { return width_; }

  /// Copies the gathers' elements, on all threads. Without enough memory, there are no panels from here on.
  void fill();
  /// Lets a frame read the panels of the columns from `x` on, where the call computes elements from x = 0, `width()`, 2 *
  /// width() ... after its first one. Indices in other columns read the nearest column of the panel.
  void moveTo(std::int64_t x, CodeFrame& frame) const;

 private:
  struct Gather {
    std::size_t parameter;
    native::Operand from;
    std::vector<std::size_t> bytes;  ///< of each scalar
    std::vector<ArrayMemory> memory;
    std::vector<void*> arrays;
  };
  /// Copies some rows of one scalar to all panels.
  void copyRows(const Gather& gather, std::size_t scalar, std::int64_t begin, std::int64_t end) const;

  std::int64_t width_ = 1;
  native::Range columns_;  ///< of the domain, which the call computes
  std::vector<Gather> gathers_;
};

}  // namespace sk
