// SPDX-License-Identifier: MIT
//
// What accurate intrinsics cost: each of them over the device's own, in a kernel that does nothing else. And what so many
// kernels cost at the start of a program that has run before.
#pragma once

#include <string>

#include <sk/sk.hpp>

#include "report.hpp"

namespace bench {

void functions(sk::Device& device, int rounds, double sampleMilliseconds, Report& report);

/// Twenty kernels on a device of this name that is new in each round: compiled programs are at best on disk.
void warmStart(const std::string& device, int rounds, Report& report);

}  // namespace bench
