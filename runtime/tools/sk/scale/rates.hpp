// SPDX-License-Identifier: MIT
//
// Measures what model.hpp needs of a device: how long kernels take, and copies between the device and host memory. Times
// are wall-clock times around Device::finish().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "accuracy/file/kernel_library.hpp"
#include "accuracy/file/ranges.hpp"
#include "scale/model.hpp"
#include "sk/device.hpp"

namespace sk_tool {

/// A kernel's time is perCall + elements * perElement.
struct Rate {
  double perCall = 0, perElement = 0;  ///< seconds
  std::string source;  ///< where it is from, for the report
  Boxes boxes = {};
};

/// Parses "NAME=2.5e9/s[,5us]": elements per second, and the time of a call (default: 0). Throws std::runtime_error.
struct GivenRate {
  std::string kernel;
  Rate rate;

  static GivenRate parse(const std::string& text);
};

/// Why a kernel cannot be measured with drawn inputs; empty if it can.
std::string obstacleToMeasuring(const Subject& subject);

/// Runs a kernel with drawn inputs on a small and on a large domain of this rank: about `elements` elements. On a GL device, also
/// on the domain without its first and last rows, and on a few rows. Throws sk::Error.
Rate measureRate(sk::Device& device, const Subject& subject, const Ranges& ranges, int rank,
                 std::int64_t elements);

/// Reads and writes small and large streams. All 0 for a native device, whose streams are in host memory.
Staging measureStaging(sk::Device& device);

}  // namespace sk_tool
