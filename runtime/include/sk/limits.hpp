// SPDX-License-Identifier: MIT
//
// What no stream and no call may exceed, beside the limits of a device (DeviceLimits). Programs are written for these numbers.
#pragma once

#include <cstdint>

namespace sk {

/// Elements in one dimension of a stream that has elements, and thereby of a domain. An index is an int, and so are the sums of two that
/// are not negative, which boundaries are found by.
inline constexpr std::int64_t mostExtent = (std::int64_t{1} << 30) - 1;

/// Elements of a stream, or of a domain, on a device with GL, where an int numbers them. A number and the length of a run that
/// begins there have a sum that is an int, too. On native devices the memory is the only limit.
inline constexpr std::int64_t mostElements = (std::int64_t{1} << 31) - (std::int64_t{1} << 16);

/// Values that a kernel pushes to one stream, or scatters where their number is not known, in a call on a device with GL: the sum
/// of four counts is an int.
inline constexpr std::int64_t mostPushes = (std::int64_t{1} << 29) - 2;

}  // namespace sk
