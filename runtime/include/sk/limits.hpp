// SPDX-License-Identifier: MIT
//
// Limits of every stream and every call, in addition to a device's own (DeviceLimits). Generated programs
// rely on them.
#pragma once

#include <cstdint>

namespace sk {

/// Extent of a stream that has elements, and thereby of a domain. Indices are ints, and boundary modes need
/// sums of two nonnegative indices to be ints, too.
inline constexpr std::int64_t mostExtent = (std::int64_t{1} << 30) - 1;

/// Elements of a stream or a domain on a GL device, which numbers them with an int. The sum of an element
/// number and the length of a run that begins there is an int, too. On native devices, memory is the only
/// limit.
inline constexpr std::int64_t mostElements = (std::int64_t{1} << 31) - (std::int64_t{1} << 16);

/// Values that one call on a GL device may push to one stream, or may scatter if their number is not known in
/// advance: the sum of four counts is an int.
inline constexpr std::int64_t mostPushes = (std::int64_t{1} << 29) - 2;

}  // namespace sk
