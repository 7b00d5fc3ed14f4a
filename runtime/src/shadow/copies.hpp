// SPDX-License-Identifier: MIT
//
// Copies elements between a device and native streams, without a loss.
#pragma once

#include <cstdint>

#include "native/native_stream.hpp"

namespace sk {

/// The bytes of a stream's elements.
std::int64_t bytesOf(const NativeStream& stream);

/// Whether a region has all elements of its stream, in order.
bool isAllInOrder(const StreamRegion& region);

/// Whether all numbers of an element are floats, which streams may store as wider numbers than host memory has.
bool holdsOnlyFloats(const program::Element& element);

/// Copies all elements of a native stream to a region of the same size on any device.
void copyToDevice(NativeStream& from, const StreamRegion& to);

/// Copies the elements of a region, on any device, to a region of the same size of a native stream of the same element type.
void copyElements(const StreamRegion& from, const StreamRegion& to);

}  // namespace sk
