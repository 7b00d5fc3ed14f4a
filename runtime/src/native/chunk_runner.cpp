// SPDX-License-Identifier: MIT
#include "native/chunk_runner.hpp"

#include <algorithm>
#include <utility>

namespace sk {

using native::Extents;

ChunkRunner::ChunkRunner(const SlotLayout& layout, const native::Entry& run, const native::Frame* frame,
                         ChunkHook hook, std::size_t rows)
    : layout_(layout),
      function_(functionOf<native::RunFunction>(run)),
      lanes_(run.lanes),
      frame_(frame),
      together_(run.rows),
      staged_(std::max(together_, rows) > 1 ? 2 * native::mostLanes : mostStaged),
      arrays_(layout, staged_, layout.isDirect() && rows == 1 ? 0 : staged_, std::max(together_, rows)),
      hook_(std::move(hook)) {
  for (std::size_t row = 0; row < std::max(together_, rows); ++row) {
    chunks_[row].arrays = arrays_.get(row);
    chunks_[row].step = 1;
  }
}

std::size_t ChunkRunner::rowsAtOnce(const SlotLayout& layout) {
  constexpr std::size_t enough = 8;
  return layout.hasGathers() && layout.isDirect() && !layout.needsElementwiseCalls() ? enough : 1;
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
  moveTo(first, rows);
  const std::int64_t begin = first[0];
  const std::int64_t end = begin + count;
  if (layout_.needsElementwiseCalls()) {
    for (std::int64_t x = begin; x < end; ++x) call(x, 1, lanes_);
    return;
  }
  if (begin == 0 && end == layout_.width() && runRows()) return;
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

bool ChunkRunner::runRows() {
  if (!layout_.hasIndependentElements() || !layout_.isDirect() || hook_.after || together_ != 1 ||
      wanted_ == 1)
    return false;
  const RowEnds ends = arrays_.ends();
  const std::int64_t end = layout_.width() - ends.right;
  const std::int64_t count = static_cast<std::int64_t>(wanted_) * ends.ofRow();
  if (end - ends.left < lanes_ || count > std::min(staged_, layout_.width())) return false;
  if (ends.left + ends.right > 0) {
    arrays_.placeEnds(ends);
    chunks_[0].count = count;
    function_(frame_, &chunks_[0]);
    arrays_.storeEnds(ends);
  }
  const std::int64_t whole = ends.left + ((end - ends.left) & -lanes_);
  runInside(ends.left, whole, hook_.longest);
  if (whole < end) runInside(end - lanes_, end, lanes_);
  return true;
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
