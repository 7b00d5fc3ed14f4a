// SPDX-License-Identifier: MIT
//
// Runs kernels one after the other in tiles, of which a thread computes all, so that streams that only they use are never whole: a tile
// has its part of them in the cache, and what the kernels read around it, too, which neighbouring tiles compute again.
//
//   rows of      |   tile   |   tile   |   tile   |
//   first       [......................]               kernel: writes a local stream for a tile, and as far around it
//   second            [................]               as the second reads
#pragma once

#include <span>

namespace sk {

class LoopState;
class NativeDevice;
class StreamState;

/// Runs the recorded calls once. Returns false, without any effect, if they cannot run in such tiles, or would gain nothing.
/// The elements of `locals`, which nothing else uses, are undefined then.
bool runInLocalTiles(NativeDevice& device, LoopState& calls, std::span<StreamState* const> locals);

}  // namespace sk
