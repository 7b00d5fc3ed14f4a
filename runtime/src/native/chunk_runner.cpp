// SPDX-License-Identifier: MIT
#include "native/chunk_runner.hpp"

#include <algorithm>
#include <utility>

namespace sk {

using native::Extents;

namespace {

/// The most rows of a block, and the most elements at the ends of its rows, with their neighbours.
constexpr std::size_t rowsOfBlock = 32;
constexpr std::int64_t endsOfBlock = 256;

/// The rows for which a runner has arrays.
std::size_t rowsPlaced(bool runsBlocks, std::size_t together, std::size_t rows) {
  return runsBlocks ? 1 : std::max(together, rows);
}

}  // namespace

ChunkRunner::ChunkRunner(const SlotLayout& layout, const native::Entry& run, const native::Frame* frame,
                         ChunkHook hook, std::size_t rows)
    : layout_(layout),
      function_(functionOf<native::RunFunction>(run)),
      lanes_(run.lanes),
      frame_(frame),
      together_(run.rows),
      runsBlocks_(rows > 1 && together_ == 1 && !hook.after && layout.hasIndependentElements() &&
                  layout.isDirect()),
      staged_(std::max(together_, rows) > 1 ? 2 * native::mostLanes : mostStaged),
      arrays_(layout, staged_, layout.isDirect() && rows == 1 ? 0 : staged_,
              rowsPlaced(runsBlocks_, together_, rows), runsBlocks_ ? endsOfBlock : 0),
      hook_(std::move(hook)) {
  for (std::size_t row = 0; row < rowsPlaced(runsBlocks_, together_, rows); ++row) {
    chunks_[row].arrays = arrays_.get(row);
    chunks_[row].step = chunks_[row].rows = 1;
    chunks_[row].rowSteps = arrays_.rowSteps();
  }
}

std::size_t ChunkRunner::rowsAtOnce(const SlotLayout& layout) {
  constexpr std::size_t enough = 8;  // whose ends are laid out together
  if (!layout.hasGathers() || !layout.isDirect() || layout.needsElementwiseCalls()) return 1;
  return layout.hasIndependentElements() ? rowsOfBlock : enough;
}

/// The entry always computes `together_` rows; results of rows that are not wanted are discarded.
void ChunkRunner::moveTo(const Extents& first, std::size_t rows) {
  wanted_ = rows;
  placed_ = (rows + together_ - 1) / together_ * together_;
  arrays_.moveTo(first, wanted_, placed_);
  for (std::size_t row = 0; row < placed_; ++row) {
    std::ranges::copy(first, chunks_[row].first);
    chunks_[row].first[1] += static_cast<std::int64_t>(std::min(row, wanted_ - 1));
  }
}

void ChunkRunner::run(const Extents& first, std::int64_t count, std::size_t rows) {
  if (!runsBlocks_) return runRow(first, count, rows);
  if (count != layout_.width()) return runPartOfRows(first, count, rows);
  Extents at = first;
  for (std::size_t left = rows, done = 0; left > 0; left -= done, at[1] += static_cast<std::int64_t>(done)) {
    done = runBlock(at, left);
    if (done == 0) {
      runRow(at, count, 1);
      done = 1;
    }
  }
}

void ChunkRunner::runPartOfRows(const Extents& first, std::int64_t count, std::size_t rows) {
  const RowEnds ends = arrays_.ends();
  const native::Range columns = layout_.columns();
  const std::int64_t begin = std::max(first[0], columns.begin + ends.left);
  const std::int64_t end = std::min(first[0] + count, columns.end - ends.right);
  const bool hasInner = end - begin >= lanes_;
  Extents at = first;
  const auto runRowPart = [&](std::int64_t from, std::int64_t to) {
    if (from >= to) return;
    Extents part = at;
    part[0] = from;
    runRow(part, to - from, 1);
  };
  for (std::size_t left = rows, done = 0; left > 0; left -= done, at[1] += static_cast<std::int64_t>(done)) {
    if (!hasInner) {
      runRowPart(first[0], first[0] + count);
      done = 1;
      continue;
    }
    Extents inner = at;
    inner[0] = begin;
    done = runInnerBlock(inner, end - begin, left);
    for (std::size_t row = 0; row < done && (begin > first[0] || end < first[0] + count); ++row) {
      at[1] += static_cast<std::int64_t>(row);
      runRowPart(first[0], begin);
      runRowPart(end, first[0] + count);
      at[1] -= static_cast<std::int64_t>(row);
    }
  }
}

std::size_t ChunkRunner::runInnerBlock(const Extents& first, std::int64_t count, std::size_t most) {
  moveTo(first, 1);
  const std::size_t rows = arrays_.blockOf(most).rows;
  computeColumns(first[0], first[0] + count, rows);
  chunks_[0].rows = 1;
  return rows;
}

void ChunkRunner::stayNear() {
  constexpr std::int64_t bytes = 16384;  // half of the nearest cache
  std::int64_t perColumn = 0;
  for (const SlotLayout::Array& array : layout_.arrays()) perColumn += array.bytes.held;
  mostColumns_ = std::max<std::int64_t>(bytes / std::max<std::int64_t>(perColumn, 1) & -native::mostLanes,
                                        2 * native::mostLanes);
}

void ChunkRunner::runRow(const Extents& first, std::int64_t count, std::size_t rows) {
  moveTo(first, rows);
  const std::int64_t begin = first[0];
  const std::int64_t end = begin + count;
  if (layout_.needsElementwiseCalls()) {
    for (std::int64_t x = begin; x < end; ++x) call(x, 1, lanes_);
    return;
  }
  const std::int64_t longest = layout_.isDirect() ? hook_.longest : std::min(staged_, hook_.longest);
  if (!layout_.hasGathers()) {
    runPart(begin, end, longest);
    return;
  }
  // a few groups of lanes at both ends of a row reach beyond it; the elements between them are read in place
  const native::Range inside = arrays_.inside();
  const std::int64_t left =
      std::min(end, begin + roundUp(std::max<std::int64_t>(inside.begin - begin, 0), lanes_));
  const std::int64_t groups = (std::min(inside.end, end) - left) / lanes_;
  const std::int64_t right = left + std::max<std::int64_t>(groups, 0) * lanes_;
  runPart(begin, left, staged_);
  if (layout_.isDirect() && wanted_ == placed_) {
    runInside(left, right, longest);
  } else {
    runPart(left, right, longest);
  }
  runPart(right, end, staged_);
}

std::size_t ChunkRunner::runBlock(const Extents& first, std::size_t most) {
  moveTo(first, 1);
  const RowEnds ends = arrays_.ends();
  const std::int64_t width = layout_.width();
  if (width - ends.left - ends.right < lanes_ || ends.ofRow() > endsOfBlock) return 0;
  const auto mostEnds = static_cast<std::size_t>(endsOfBlock / std::max<std::int64_t>(ends.ofRow(), 1));
  const SlotArrays::Block block = arrays_.blockOf(std::min(most, mostEnds));
  if (ends.left + ends.right > 0) {
    chunks_[0].arrays = arrays_.placeEnds(ends, block.rows);
    chunks_[0].rows = 1;
    chunks_[0].count = static_cast<std::int64_t>(block.rows) * ends.ofRow();
    function_(frame_, &chunks_[0]);
    chunks_[0].arrays = arrays_.get();
  }
  // Where code may read beyond the ends of rows, vectors begin with the first element, so that they are aligned if
  // rows are. What they store at the ends is overwritten.
  const native::Range columns = layout_.columns();
  const std::int64_t begin = columns.begin + (block.mayCrossEnds ? 0 : ends.left);
  const std::int64_t end = columns.end - (block.mayCrossEnds ? 0 : ends.right);
  computeColumns(begin, end, block.rows);
  arrays_.storeEnds(ends, block.rows);
  chunks_[0].rows = 1;
  return block.rows;
}

void ChunkRunner::computeColumns(std::int64_t begin, std::int64_t end, std::size_t rows) {
  const std::int64_t whole = (end - begin) & -lanes_;
  for (std::int64_t x = 0; x < whole; x += std::min(mostColumns_, whole))
    computeBlock(begin + x, std::min(mostColumns_, whole - x), rows);
  if (begin + whole < end) computeBlock(end - lanes_, lanes_, rows);
}

void ChunkRunner::computeBlock(std::int64_t x, std::int64_t count, std::size_t rows) {
  arrays_.placeInside(x);
  chunks_[0].first[0] = x;
  chunks_[0].count = count;
  chunks_[0].rows = static_cast<std::int64_t>(rows);
  function_(frame_, &chunks_[0]);
}

void ChunkRunner::runPart(std::int64_t begin, std::int64_t end, std::int64_t longest) {
  while (begin < end) {
    const std::int64_t count = std::min(end - begin, longest);
    const std::int64_t whole = count & -lanes_;
    if (whole > 0) call(begin, whole, whole);
    if (whole < count) call(begin + whole, count - whole, lanes_);
    begin += count;
  }
}

void ChunkRunner::runInside(std::int64_t begin, std::int64_t end, std::int64_t longest) {
  for (std::int64_t x = begin, count = 0; x < end; x += count) {
    count = std::min(end - x, longest);
    arrays_.placeInside(x);
    compute(x, count);
  }
}

void ChunkRunner::call(std::int64_t x, std::int64_t count, std::int64_t room) {
  arrays_.place(x, count, room);
  compute(x, count);
  if (count < room || layout_.hasStridedOutputs()) arrays_.storeOutputs(x, count, room);
}

void ChunkRunner::compute(std::int64_t x, std::int64_t count) {
  for (std::size_t row = 0; row < placed_; ++row) {
    chunks_[row].first[0] = x;
    chunks_[row].count = count;
  }
  for (std::size_t row = 0; row < placed_; row += together_) function_(frame_, &chunks_[row]);
  if (hook_.after) hook_.after();
}

}  // namespace sk
