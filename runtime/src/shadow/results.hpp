// SPDX-License-Identifier: MIT
//
// What a shadow records about streams outside of calls: what the host reads, what nothing reads, and sorted keys.
#pragma once

#include "sk/stream.hpp"

namespace sk {

class ShadowStream;

/// The host has read the elements of a region: compares them with the reference's.
void recordRead(ShadowStream& stream, const StreamRegion& region);

/// The elements have been overwritten, or their stream ends: counts those that nothing has read.
void recordLifetime(ShadowStream& stream);

/// Keys have been brought into the order that the device's have: looks whether the reference's are in order then.
void recordOrder(ShadowStream& stream, const StreamRegion& keys);

}  // namespace sk
