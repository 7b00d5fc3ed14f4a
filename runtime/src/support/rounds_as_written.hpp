// SPDX-License-Identifier: MIT
//
// For code that counts on the rounding of each operation: exact and compensated sums, pairs of numbers.
#pragma once

#ifdef __FAST_MATH__
#error "exact sums need each operation as it is written; compile StreamKernel without -ffast-math and -Ofast"
#endif
