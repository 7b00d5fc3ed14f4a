// SPDX-License-Identifier: MIT
//
// The bytes of boxes of streams, as they travel between ranks.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sk/future.hpp"
#include "sk/stream.hpp"

namespace sk::mpi {

/// Contiguous memory of a native stream.
struct Span {
  std::byte* bytes;
  std::size_t count;
};

/// Whether the elements of a region are in host memory, where others may read and write them.
bool isInMemory(const StreamRegion& region);
/// The memory of a box of a native stream, in the order of its bytes.
std::vector<Span> spansOf(const StreamRegion& region);
/// Whether a GL device stores the floats of a region as doubles, which travel as such.
bool holdsReals(const StreamRegion& region);
/// The bytes of a region: as a native device stores them, one array after the other, or as elements of a GL device.
std::size_t bytesOf(const StreamRegion& region);

/// Copies a region's bytes to or from a buffer, on any device. Reading waits for the device; written bytes may change afterwards.
void readBytes(const StreamRegion& region, std::byte* to);
void writeBytes(const StreamRegion& region, const std::byte* from);

/// Copies a region's bytes between a native stream and a buffer.
void pack(std::span<const Span> from, std::byte* to);
void unpack(const std::byte* from, std::span<const Span> to);

}  // namespace sk::mpi
