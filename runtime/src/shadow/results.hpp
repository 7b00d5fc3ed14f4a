// SPDX-License-Identifier: MIT
//
// What a shadow records about streams outside of calls: what the host reads, and what nothing reads.
#pragma once

#include <cstdint>
#include <string>

#include "sk/stream.hpp"

namespace sk {

class ShadowStream;

/// The host has read the elements of a region: compares them with the reference's.
void recordRead(ShadowStream& stream, const StreamRegion& region);

/// Measures errors that are only estimated (StreamErrors::isEstimated).
void measureErrors(ShadowStream& stream);

/// The elements have been overwritten, or their stream ends: counts those that nothing has read.
void recordLifetime(ShadowStream& stream);

/// The host has learnt how many elements a kernel or an algorithm has chosen.
void recordCount(ShadowStream& stream, const std::string& name, std::int64_t device, std::int64_t reference);

}  // namespace sk
