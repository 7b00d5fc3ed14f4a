// SPDX-License-Identifier: MIT
//
// Each program as a good C++ programmer would write it for a machine with several cores: OpenMP, loops that the
// compiler vectorises, compiled with -O3 -march=native. No intrinsics of one machine, and nothing of the runtime.
#pragma once

#include "contender.hpp"

namespace race {

void saxpyOpenMp(const Problem& p, float* r);
void sumOpenMp(const Problem& p, float* total);
void compensatedSumOpenMp(const Problem& p, float* total);
void dotOpenMp(const Problem& p, float* total);
void heatOpenMp(const Problem& p, float* v);
void binomialOpenMp(const Problem& p, float* v);
void mandelbrotOpenMp(const Problem& p, float* steps);

}  // namespace race
