// SPDX-License-Identifier: MIT
//
// The implementation of sk::Rows: the starts of rows, how they are divided into pieces, and tables of the pieces in
// streams, which GL devices read.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <vector>

#include "call/row_pieces.hpp"
#include "sk/rows.hpp"
#include "sk/stream.hpp"

namespace sk {

class DeviceState;

class RowsState {
 public:
  /// Row i has the elements starts[i] to starts[i + 1] - 1.
  RowsState(DeviceState& device, std::vector<std::int32_t> starts);
  RowsState(const RowsState&) = delete;
  RowsState& operator=(const RowsState&) = delete;

  /// Null after the device has ended.
  const DeviceState* device() const;
  const RowPieces& pieces() const { return levels_.front().pieces; }
  std::int64_t rows() const { return pieces().rows(); }
  std::int64_t begin() const { return pieces().starts().front(); }
  std::int64_t end() const { return pieces().starts().back(); }
  /// The first row without elements; -1 if there is none.
  std::int64_t firstEmptyRow() const { return firstEmptyRow_; }
  /// The first row that ends beyond this many elements; -1 if there is none.
  std::int64_t rowBeyond(std::int64_t elements) const;

  /// A level: rows of elements, or of the pieces of the level before. Each row of the last level is one piece.
  struct Level {
    RowPieces pieces;
    /// int2 for each piece: its first element, and the number of its elements.
    detail::StreamOwner table = {};
    /// int4 for each group: RowPieces::Group. Level 0 only.
    detail::StreamOwner groups = {};
    /// int2 for each element of the level: how many elements of its piece precede it, and the number of the piece before
    /// if that is in the same row, else -1. Scans only.
    detail::StreamOwner places = {};
  };
  const std::deque<Level>& levels() const { return levels_; }
  /// Makes the tables of all levels, if they are missing.
  void makeTables(bool ofScans) const;

  /// Owners share it: the application's handle, and the loops that have recorded calls with it.
  void share() const noexcept { ++owners_; }
  void leave() const noexcept {
    if (--owners_ == 0) delete this;
  }

 private:
  ~RowsState() = default;
  void makePieces(Level& level) const;
  void makeGroups(Level& level) const;
  void makePlaces(Level& level) const;

  mutable std::atomic<int> owners_ = 1;
  detail::StreamOwner anchor_;  ///< knows whether the device exists
  mutable std::deque<Level> levels_;
  std::int64_t firstEmptyRow_ = -1;
};

/// A share of rows; or none.
class SharedRows {
 public:
  explicit SharedRows(const RowsState* rows) : rows_(rows) {
    if (rows_ != nullptr) rows_->share();
  }
  ~SharedRows() {
    if (rows_ != nullptr) rows_->leave();
  }
  SharedRows(const SharedRows&) = delete;
  SharedRows& operator=(const SharedRows&) = delete;

 private:
  const RowsState* rows_;
};

}  // namespace sk
