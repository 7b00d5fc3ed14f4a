// SPDX-License-Identifier: MIT
//
// What accurate intrinsics cost: each of them over the device's own, in a kernel that does nothing else.
#pragma once

#include <sk/sk.hpp>

#include "report.hpp"

namespace bench {

void functions(sk::Device& device, int rounds, double sampleMilliseconds, Report& report);

}  // namespace bench
