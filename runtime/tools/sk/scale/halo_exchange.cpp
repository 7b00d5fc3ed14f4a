// SPDX-License-Identifier: MIT
#include "scale/halo_exchange.hpp"

#include <algorithm>

namespace sk_tool {

namespace {

void addGrids(std::int64_t count, std::size_t rank, Extents& parts, std::vector<Extents>& grids) {
  if (parts.size() + 1 == rank) {
    parts.push_back(count);
    grids.push_back(parts);
    parts.pop_back();
    return;
  }
  for (std::int64_t part = 1; part <= count; ++part) {
    if (count % part != 0) continue;
    parts.push_back(part);
    addGrids(count / part, rank, parts, grids);
    parts.pop_back();
  }
}

/// The offsets of all neighbours: -1, 0 or 1 in each dimension that is split, not all of them 0.
std::vector<Extents> directionsOf(const Extents& parts) {
  std::vector<Extents> directions = {Extents(parts.size(), 0)};
  for (std::size_t d = 0; d < parts.size(); ++d) {
    if (parts[d] == 1) continue;
    const std::size_t count = directions.size();
    for (const std::int64_t step : {-1, 1}) {
      for (std::size_t i = 0; i < count; ++i) {
        directions.push_back(directions[i]);
        directions.back()[d] = step;
      }
    }
  }
  directions.erase(directions.begin());
  return directions;
}

bool hasNeighbor(const Split& split, const Extents& place, const Extents& direction) {
  for (std::size_t d = 0; d < place.size(); ++d) {
    const std::int64_t there = place[d] + direction[d];
    if ((there < 0 || there >= split.parts[d]) && !split.periodic[d]) return false;
  }
  return true;
}

}  // namespace

std::vector<Extents> processGrids(std::int64_t count, std::size_t rank) {
  std::vector<Extents> grids;
  Extents parts;
  addGrids(count, rank, parts, grids);
  return grids;
}

int splitDimensions(const Extents& parts) {
  return static_cast<int>(std::ranges::count_if(parts, [](std::int64_t part) { return part > 1; }));
}

std::int64_t partExtent(std::int64_t extent, std::int64_t parts, std::int64_t index) {
  return extent / parts + (index < extent % parts ? 1 : 0);
}

std::int64_t volumeOf(const Extents& block) {
  std::int64_t volume = 1;
  for (const std::int64_t extent : block) volume *= extent;
  return volume;
}

Halo Split::halo(std::size_t dimension, const Halo& read) const {
  if (parts[dimension] == 1) return {};
  if (parts[dimension] > 2 || !periodic[dimension]) return read;
  const std::int64_t deeper = std::max(read.below, read.above);
  return {deeper, deeper};
}

Sent sentBy(const Split& split, const Extents& block, const Extents& place,
            std::span<const ExchangedStream> streams) {
  Sent sent;
  for (const Extents& direction : directionsOf(split.parts)) {
    if (!hasNeighbor(split, place, direction)) continue;
    double bytes = 0;
    for (const ExchangedStream& stream : streams) {
      double elements = 1;
      for (std::size_t d = 0; d < block.size(); ++d) {
        const Halo halo = split.halo(d, stream.halo[d]);
        // A neighbour after the block reads what lies before its own elements.
        const std::int64_t depth = direction[d] > 0 ? halo.below : halo.above;
        elements *= static_cast<double>(direction[d] == 0 ? block[d] : depth);
      }
      bytes += elements * static_cast<double>(stream.bytes);
    }
    if (bytes > 0) ++sent.messages;
    sent.bytes += bytes;
  }
  return sent;
}

}  // namespace sk_tool
