// SPDX-License-Identifier: MIT
//
// How fast a device copies a large stream: what the trace measures passes by. It is measured once for each driver, in
// some tenths of a second, and kept in the cache folder.
#pragma once

#include <string_view>

namespace sk {

class GlDevice;

/// Bytes in a nanosecond (GB/s), read and written ones together, by the fastest of the ways to copy; 0 where there is no
/// memory to measure it with. No DeviceScope may be open.
double copyBandwidth(GlDevice& device);

/// The same for arrays in host memory, copied by a thread for each processor.
double hostCopyBandwidth();

}  // namespace sk
