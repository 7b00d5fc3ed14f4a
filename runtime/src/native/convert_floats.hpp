// SPDX-License-Identifier: MIT
//
// Converts arrays of floats to doubles and back, with vectors where the CPU has them.
#pragma once

#include <cstdint>

namespace sk {

/// The arrays must not overlap.
void widenFloats(const float* from, std::int64_t count, double* to);
/// Rounds to nearest, ties to even.
void narrowDoubles(const double* from, std::int64_t count, float* to);

}  // namespace sk
