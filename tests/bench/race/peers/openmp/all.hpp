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
void gemvOpenMp(const Problem& p, float* y);
void gemmOpenMp(const Problem& p, float* c);
std::unique_ptr<Task> scanOpenMp(const Problem& p);
std::unique_ptr<Task> compactionSerial(const Problem& p);
std::unique_ptr<Task> compactionOpenMp(const Problem& p);
void sortOpenMp(const Problem& p, float* sorted);
void sortPairsOpenMp(const Problem& p, float* sorted);
void bodiesOpenMp(const Problem& p, float* accelerations);
std::unique_ptr<Task> fourierOpenMp(const Problem& p);
std::unique_ptr<Task> reactionOpenMp(const Problem& p);
std::unique_ptr<Task> boilingOpenMp(const Problem& p);
std::unique_ptr<Task> convectionOpenMp(const Problem& p);
std::unique_ptr<Task> reactionStepOpenMp(const Problem& p);
std::unique_ptr<Task> clothOpenMp(const Problem& p);
void raysOpenMp(const Problem& p, float* hits);
void residualOpenMp(const Problem& p, float* result);
void sparseOpenMp(const Problem& p, float* y);
std::unique_ptr<Task> diagonalsOpenMp(const Problem& p);
std::unique_ptr<Task> gradientsOpenMp(const Problem& p);
std::unique_ptr<Task> heatLoopOpenMp(const Problem& p);
std::unique_ptr<Task> reactionLoopOpenMp(const Problem& p);
std::unique_ptr<Task> waveLoopOpenMp(const Problem& p);
std::unique_ptr<Task> chainOpenMp(const Problem& p);

}  // namespace race
