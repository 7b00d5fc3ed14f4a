// SPDX-License-Identifier: MIT
//
// Divides rows of different lengths into pieces that take about the same time, and these into groups. Pure arithmetic.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace sk {

/// Each row is one piece if it has at most program::longestRun elements; a longer row is several such pieces, of which
/// only the last may be shorter. A row without elements is a piece without elements. Pieces are in order.
class RowPieces {
 public:
  /// The most elements and pieces of a group.
  static constexpr std::int32_t groupElements = 1024, groupPieces = 256;
  /// The most pieces of a batch, a power of 2.
  static constexpr std::int32_t batchPieces = 64;

  struct LongRow {
    std::int32_t row, firstPiece, pieces;
  };
  /// Consecutive pieces of a long row: all of them or, if they are too many, a part.
  struct Batch {
    std::int32_t longRow;  ///< index in longRows()
    std::int32_t firstPiece, pieces;
    std::int32_t number;  ///< of batches before it in the order of rows
  };
  /// Consecutive pieces, and their elements.
  struct Group {
    std::int32_t firstPiece, pieces, firstElement, elements;
  };

  /// Row i has the elements starts[i] to starts[i + 1] - 1. There is at least one start, and none decreases.
  explicit RowPieces(std::vector<std::int32_t> starts);

  std::int64_t rows() const { return static_cast<std::int64_t>(starts_.size()) - 1; }
  std::span<const std::int32_t> starts() const { return starts_; }
  std::int64_t count() const { return static_cast<std::int64_t>(pieceStarts().size()) - 1; }
  /// The first element of each piece, and the end of the last one.
  std::span<const std::int32_t> pieceStarts() const { return longRows_.empty() ? starts_ : cut_; }
  /// The rows that have several pieces, in order.
  std::span<const LongRow> longRows() const { return longRows_; }
  std::span<const Group> groups() const { return groups_; }
  /// The batches of all long rows, those of fewer pieces first.
  std::span<const Batch> batches() const { return batches_; }

  /// The first piece of each row, and the number of all pieces: the starts of rows whose elements are the pieces.
  std::vector<std::int32_t> firstPieces() const;

 private:
  void cutLongRows();
  void formGroups();
  void formBatches();

  std::vector<std::int32_t> starts_;
  std::vector<std::int32_t> cut_;  ///< empty if no row is long
  std::vector<LongRow> longRows_;
  std::vector<Group> groups_;
  std::vector<Batch> batches_;
};

}  // namespace sk
