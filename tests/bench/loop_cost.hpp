// SPDX-License-Identifier: MIT
//
// What the host spends on a call that a loop repeats (sk::Loop).
#pragma once

#include <sk/sk.hpp>

#include "report.hpp"

namespace bench {

/// On the device, which is not waited for, and natively, where a call of few elements costs little else.
void loopCosts(sk::Device& device, int rounds, Report& report);

}  // namespace bench
