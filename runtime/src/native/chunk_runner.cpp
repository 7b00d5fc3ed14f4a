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
      arrays_(layout, mostLaidOut, layout.isDirect() ? 0 : mostLaidOut),
      hook_(std::move(hook)) {
  chunk_.arrays = arrays_.get();
  chunk_.step = 1;
}

void ChunkRunner::moveTo(const Extents& first) { std::ranges::copy(first, chunk_.first); }

void ChunkRunner::run(const Extents& first, std::int64_t count) {
  arrays_.moveToRow(first);
  moveTo(first);
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
  const native::Range inside = arrays_.inside();
  const std::int64_t left =
      std::min(end, begin + roundUp(std::max<std::int64_t>(inside.begin - begin, 0), lanes_));
  const std::int64_t groups = (std::min(inside.end, end) - left) / lanes_;
  const std::int64_t right = left + std::max<std::int64_t>(groups, 0) * lanes_;
  runPart(begin, left, mostLaidOut);
  runPart(left, right, longest);
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

void ChunkRunner::call(std::int64_t x, std::int64_t count, std::int64_t room) {
  arrays_.place(x, count, room);
  chunk_.first[0] = x;
  chunk_.count = count;
  function_(frame_, &chunk_);
  if (count < room) arrays_.storeOutputs(x, count);
  if (hook_.after) hook_.after();
}

}  // namespace sk
