// SPDX-License-Identifier: MIT
//
// Measures how fast a device copies a large stream, with which the trace compares passes. The measurement
// takes some tenths of a second, once per driver, and is kept in the cache folder.
#pragma once

#include <string_view>

namespace sk {

class GlDevice;

/// Bytes read and written per nanosecond (GB/s), with the fastest way to copy; 0 if there is no memory to
/// measure it. No DeviceScope may be open.
double copyBandwidth(GlDevice& device);

/// The same for arrays in host memory, copied by one thread per processor.
double hostCopyBandwidth();

}  // namespace sk
