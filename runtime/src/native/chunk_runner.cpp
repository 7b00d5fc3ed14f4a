// SPDX-License-Identifier: MIT
#include "native/chunk_runner.hpp"

#include <algorithm>
#include <utility>

namespace sk {

using native::Extents;

ChunkRunner::ChunkRunner(const SlotLayout& layout, const native::Entry& run, const native::Frame* frame,
                         ChunkHook hook)
    : layout_(layout),
      function_(functionOf<native::RunFunction>(run)),
      lanes_(run.lanes),
      frame_(frame),
      rows_(run.rows),
      hook_(std::move(hook)) {
  for (std::size_t row = 0; row < rows_; ++row) {
    arrays_[row].emplace(layout, mostLaidOut, layout.isDirect() ? 0 : mostLaidOut);
    chunks_[row].arrays = arrays_[row]->get();
    chunks_[row].step = 1;
  }
}

/// Rows that are not wanted compute the last one again, and nobody looks at what.
void ChunkRunner::moveTo(const Extents& first, std::size_t rows) {
  wanted_ = rows;
  Extents at = first;
  for (std::size_t row = 0; row < rows_; ++row) {
    arrays_[row]->moveToRow(at);
    std::ranges::copy(at, chunks_[row].first);
    if (row + 1 < wanted_) ++at[1];
  }
}

/// Where no row's gathers need copies.
native::Range ChunkRunner::inside() const {
  native::Range all = arrays_[0]->inside();
  for (std::size_t row = 1; row < rows_; ++row) {
    const native::Range one = arrays_[row]->inside();
    all = {std::max(all.begin, one.begin), std::min(all.end, one.end)};
  }
  return all;
}

void ChunkRunner::run(const Extents& first, std::int64_t count, std::size_t rows) {
  moveTo(first, rows);
  const std::int64_t begin = first[0];
  const std::int64_t end = begin + count;
  if (layout_.goesByElement()) {
    for (std::int64_t x = begin; x < end; ++x) call(x, 1, lanes_);
    return;
  }
  const std::int64_t longest = layout_.isDirect() ? hook_.longest : std::min(mostLaidOut, hook_.longest);
  if (!layout_.hasGathers()) {
    runPart(begin, end, longest);
    return;
  }
  // a few groups at both ends of a row look over its margins; the elements between them are read where they lie
  const native::Range inside = this->inside();
  const std::int64_t left =
      std::min(end, begin + roundUp(std::max<std::int64_t>(inside.begin - begin, 0), lanes_));
  const std::int64_t groups = (std::min(inside.end, end) - left) / lanes_;
  const std::int64_t right = left + std::max<std::int64_t>(groups, 0) * lanes_;
  runPart(begin, left, mostLaidOut);
  if (layout_.isDirect() && wanted_ == rows_) {
    runInside(left, right, longest);
  } else {
    runPart(left, right, longest);
  }
  runPart(right, end, mostLaidOut);
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
    for (std::size_t row = 0; row < rows_; ++row) {
      arrays_[row]->placeInside(x);
      chunks_[row].first[0] = x;
      chunks_[row].count = count;
    }
    function_(frame_, chunks_.data());
    if (hook_.after) hook_.after();
  }
}

void ChunkRunner::call(std::int64_t x, std::int64_t count, std::int64_t room) {
  for (std::size_t row = 0; row < rows_; ++row) {
    arrays_[row]->place(x, count, room, 1, row < wanted_);
    chunks_[row].first[0] = x;
    chunks_[row].count = count;
  }
  function_(frame_, chunks_.data());
  if (count < room) {
    for (std::size_t row = 0; row < wanted_; ++row) arrays_[row]->storeOutputs(x, count);
  }
  if (hook_.after) hook_.after();
}

}  // namespace sk
