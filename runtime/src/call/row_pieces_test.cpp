// SPDX-License-Identifier: MIT
//
// Promises: pieces have all elements of all rows in order, each of at most program::longestRun, and groups have all
// pieces within their limits, whatever the rows are. Batches have all pieces of long rows.
#include "call/row_pieces.hpp"

#include <algorithm>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "sk/program.hpp"

namespace sk {
namespace {

std::vector<std::int32_t> startsOf(const std::vector<std::int32_t>& lengths, std::int32_t first = 0) {
  std::vector<std::int32_t> starts{first};
  for (const std::int32_t length : lengths) starts.push_back(starts.back() + length);
  return starts;
}

void checkBatches(const RowPieces& pieces) {
  std::vector<RowPieces::Batch> batches(pieces.batches().begin(), pieces.batches().end());
  CHECK(std::ranges::is_sorted(batches, {}, &RowPieces::Batch::pieces));
  std::ranges::sort(batches, {}, &RowPieces::Batch::number);
  std::size_t next = 0;
  for (std::size_t i = 0; i < pieces.longRows().size(); ++i) {
    const RowPieces::LongRow& row = pieces.longRows()[i];
    for (std::int32_t first = 0; first < row.pieces; first += RowPieces::batchPieces, ++next) {
      REQUIRE(next < batches.size());
      CHECK(batches[next].number == static_cast<std::int32_t>(next));
      CHECK(batches[next].longRow == static_cast<std::int32_t>(i));
      CHECK(batches[next].firstPiece == row.firstPiece + first);
      CHECK(batches[next].pieces == std::min(row.pieces - first, RowPieces::batchPieces));
    }
  }
  CHECK(next == batches.size());
}

void checkPieces(const std::vector<std::int32_t>& lengths, std::int32_t first = 0) {
  const std::vector<std::int32_t> starts = startsOf(lengths, first);
  const RowPieces pieces(starts);
  REQUIRE(pieces.rows() == static_cast<std::int64_t>(lengths.size()));
  const std::vector<std::int32_t> firstPieces = pieces.firstPieces();
  REQUIRE(firstPieces.size() == starts.size());
  REQUIRE(firstPieces.back() == pieces.count());
  const auto cut = pieces.pieceStarts();
  for (std::size_t row = 0; row < starts.size(); ++row)
    REQUIRE(cut[static_cast<std::size_t>(firstPieces[row])] == starts[row]);
  std::size_t longRows = 0;
  for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
    const std::int32_t count = firstPieces[row + 1] - firstPieces[row];
    REQUIRE(count >= 1);
    if (count == 1) continue;
    REQUIRE(longRows < pieces.longRows().size());
    const RowPieces::LongRow& longRow = pieces.longRows()[longRows++];
    CHECK(longRow.row == static_cast<std::int32_t>(row));
    CHECK(longRow.firstPiece == firstPieces[row]);
    CHECK(longRow.pieces == count);
  }
  CHECK(longRows == pieces.longRows().size());
  for (std::size_t i = 0; i + 1 < cut.size(); ++i) {
    REQUIRE(cut[i] <= cut[i + 1]);
    REQUIRE(cut[i + 1] - cut[i] <= program::longestRun);
  }
  std::int32_t next = 0;
  for (const RowPieces::Group& group : pieces.groups()) {
    REQUIRE(group.firstPiece == next);
    REQUIRE(group.pieces >= 1);
    CHECK(group.pieces <= RowPieces::groupPieces);
    CHECK(group.elements <= RowPieces::groupElements);
    CHECK(group.firstElement == cut[static_cast<std::size_t>(next)]);
    next += group.pieces;
    CHECK(group.firstElement + group.elements == cut[static_cast<std::size_t>(next)]);
  }
  CHECK(next == pieces.count());
  checkBatches(pieces);
}

TEST_CASE("rows of any lengths are cut into pieces, and these are grouped") {
  checkPieces({});
  checkPieces({}, 7);
  checkPieces({0});
  checkPieces({1}, 3);
  checkPieces({32});
  checkPieces({33});
  checkPieces({64, 0, 65});
  checkPieces({1 << 20});
  checkPieces(std::vector<std::int32_t>(100000, 0));
  checkPieces({0, 0, 5000, 0, 1, 31, 32, 33, 0});
  std::mt19937 random(1);
  std::vector<std::int32_t> lengths(3000);
  for (std::int32_t& length : lengths) length = static_cast<std::int32_t>(random() % 50);
  checkPieces(lengths);
  for (std::int32_t& length : lengths)
    length = random() % 100 == 0 ? static_cast<std::int32_t>(random() % 9000) : 0;
  checkPieces(lengths, 11);
}

}  // namespace
}  // namespace sk
