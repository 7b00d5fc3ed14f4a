// SPDX-License-Identifier: MIT
#include "device/rows_state.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "sk/host_vector.hpp"
#include "sk/types.hpp"

namespace sk {

namespace {

detail::StreamOwner streamOf(DeviceState& device, const program::Element& element, std::size_t count,
                             const void* elements) {
  const Shape shape{static_cast<std::int64_t>(count)};
  detail::StreamOwner stream(device.createStream(element, shape, Storage::Single).release());
  if (count > 0)
    stream.get()->write(detail::wholeRegion(stream.get()), static_cast<const std::byte*>(elements));
  return stream;
}

}  // namespace

RowsState::RowsState(DeviceState& device, std::vector<std::int32_t> starts)
    : anchor_(device.createStream(ElementTraits<int>::element(), {1}, Storage::Single).release()) {
  levels_.push_back({RowPieces(std::move(starts))});
  while (!levels_.back().pieces.longRows().empty())
    levels_.push_back({RowPieces(levels_.back().pieces.firstPieces())});
  const std::span<const std::int32_t> all = pieces().starts();
  const auto empty = std::ranges::adjacent_find(all);
  if (empty != all.end()) firstEmptyRow_ = empty - all.begin();
}

const DeviceState* RowsState::device() const { return anchor_.get()->device; }

std::int64_t RowsState::rowBeyond(std::int64_t elements) const {
  const std::span<const std::int32_t> ends = pieces().starts().subspan(1);
  const auto beyond =
      std::ranges::upper_bound(ends, elements, {}, [](std::int32_t end) -> std::int64_t { return end; });
  return beyond == ends.end() ? -1 : beyond - ends.begin();
}

void RowsState::makeTables(bool ofScans) const {
  for (Level& level : levels_) {
    if (!level.table) makePieces(level);
    if (ofScans && !level.places) makePlaces(level);
  }
  if (!levels_.front().groups) makeGroups(levels_.front());
}

void RowsState::makePieces(Level& level) const {
  const std::span<const std::int32_t> starts = level.pieces.pieceStarts();
  auto pieces = detail::hostVector<int2>(starts.size() - 1);
  for (std::size_t i = 0; i < pieces.size(); ++i) pieces[i] = {starts[i], starts[i + 1] - starts[i]};
  level.table =
      streamOf(*anchor_.get()->device, ElementTraits<int2>::element(), pieces.size(), pieces.data());
}

void RowsState::makeGroups(Level& level) const {
  std::vector<int4> groups;
  groups.reserve(level.pieces.groups().size());
  for (const RowPieces::Group& group : level.pieces.groups())
    groups.push_back({group.firstPiece, group.pieces, group.firstElement, group.elements});
  level.groups =
      streamOf(*anchor_.get()->device, ElementTraits<int4>::element(), groups.size(), groups.data());
}

void RowsState::makePlaces(Level& level) const {
  const std::span<const std::int32_t> starts = level.pieces.pieceStarts();
  const std::vector<std::int32_t> firstPieces = level.pieces.firstPieces();
  auto places = detail::hostVector<int2>(static_cast<std::size_t>(starts.back()));
  for (std::size_t row = 0; row + 1 < firstPieces.size(); ++row) {
    for (std::int32_t piece = firstPieces[row]; piece < firstPieces[row + 1]; ++piece) {
      const std::int32_t carry = piece == firstPieces[row] ? -1 : piece - 1;
      const std::int32_t begin = starts[static_cast<std::size_t>(piece)];
      const std::int32_t end = starts[static_cast<std::size_t>(piece) + 1];
      for (std::int32_t i = begin; i < end; ++i) places[static_cast<std::size_t>(i)] = {i - begin, carry};
    }
  }
  level.places =
      streamOf(*anchor_.get()->device, ElementTraits<int2>::element(), places.size(), places.data());
}

}  // namespace sk
