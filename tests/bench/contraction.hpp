// SPDX-License-Identifier: MIT
//
// What Contraction::Exact costs: kernels and compensated sums whose operations are computed as they are written, over the same with
// Contraction::Fast, on the software renderer with each means that GLSL has. The figures in docs/accuracy.md come from here.
#pragma once

#include "report.hpp"

namespace bench {

/// The time that counts is the processor's. A bar is missed where Exact takes more than 1.03 times as long as Fast; compensated sums
/// may take 1.02 times as long.
void contractions(int rounds, double sampleMilliseconds, Report& report);

}  // namespace bench
