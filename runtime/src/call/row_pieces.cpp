// SPDX-License-Identifier: MIT
#include "call/row_pieces.hpp"

#include <algorithm>
#include <utility>

#include "sk/host_vector.hpp"
#include "sk/program.hpp"

namespace sk {

RowPieces::RowPieces(std::vector<std::int32_t> starts) : starts_(std::move(starts)) {
  cutLongRows();
  formGroups();
  formBatches();
}

void RowPieces::cutLongRows() {
  std::int32_t pieces = 0;
  for (std::size_t row = 0; row + 1 < starts_.size(); ++row) {
    const std::int32_t length = starts_[row + 1] - starts_[row];
    const std::int32_t parts = length == 0 ? 1 : (length - 1) / program::longestRun + 1;
    if (parts > 1) longRows_.push_back({static_cast<std::int32_t>(row), pieces, parts});
    pieces += parts;
  }
  if (longRows_.empty()) return;
  cut_ = detail::hostVector<std::int32_t>(static_cast<std::size_t>(pieces) + 1);
  auto next = cut_.begin();
  for (std::size_t row = 0; row + 1 < starts_.size(); ++row) {
    *next++ = starts_[row];
    const std::int32_t end = starts_[row + 1];
    for (std::int32_t length = end - starts_[row]; length > program::longestRun;
         length -= program::longestRun, ++next)
      *next = next[-1] + program::longestRun;
  }
  *next = starts_.back();
}

void RowPieces::formGroups() {
  const std::span<const std::int32_t> starts = pieceStarts();
  const auto pieces = static_cast<std::int32_t>(count());
  for (std::int32_t first = 0, end = 0; first < pieces; first = end) {
    const std::int32_t begin = starts[static_cast<std::size_t>(first)];
    const std::int32_t most = std::min(groupPieces, pieces - first);
    while (end - first < most && starts[static_cast<std::size_t>(end) + 1] - begin <= groupElements) ++end;
    groups_.push_back({first, end - first, begin, starts[static_cast<std::size_t>(end)] - begin});
  }
}

void RowPieces::formBatches() {
  std::int32_t number = 0;
  for (std::size_t i = 0; i < longRows_.size(); ++i) {
    const LongRow& row = longRows_[i];
    for (std::int32_t first = 0; first < row.pieces; first += batchPieces) {
      batches_.push_back({static_cast<std::int32_t>(i), row.firstPiece + first,
                          std::min(batchPieces, row.pieces - first), number++});
    }
  }
  std::ranges::stable_sort(batches_, {}, &Batch::pieces);
}

std::vector<std::int32_t> RowPieces::firstPieces() const {
  auto first = detail::hostVector<std::int32_t>(starts_.size());
  auto next = longRows_.begin();
  std::int32_t more = 0;  // pieces beyond one for each row
  for (std::size_t row = 0; row < first.size(); ++row) {
    first[row] = static_cast<std::int32_t>(row) + more;
    if (next == longRows_.end() || next->row != static_cast<std::int32_t>(row)) continue;
    more += next->pieces - 1;
    ++next;
  }
  return first;
}

}  // namespace sk
