// SPDX-License-Identifier: MIT
//
// The functions of all programs, which the table in programs.cpp is made of.
#pragma once

#include "programs.hpp"

namespace race {

#define RACE_OURS(name) \
  std::unique_ptr<Task> name##Ours(sk::Device& device, const sk::CallOptions& options, const Problem& problem)

#define RACE_CALLS(name)                                                                \
  std::unique_ptr<Task> name##Calls(sk::Device& device, const sk::CallOptions& options, \
                                    const Problem& problem)

Problem saxpyProblem(int log2);
Check saxpyCheck(const Problem& problem);
RACE_OURS(saxpy);

Problem sumProblem(int log2);
Check sumCheck(const Problem& problem);
RACE_OURS(sum);
Check compensatedSumCheck(const Problem& problem);
RACE_OURS(compensatedSum);
Problem dotProblem(int log2);
Check dotCheck(const Problem& problem);
RACE_OURS(dot);

Check heatCheck(const Problem& problem);
RACE_OURS(heat);
Check binomialCheck(const Problem& problem);
RACE_OURS(binomial);

Check mandelbrotCheck(const Problem& problem);
RACE_OURS(mandelbrot);

Problem gemvProblem(int log2);
Check gemvCheck(const Problem& problem);
RACE_OURS(gemv);
Problem gemmProblem(int log2);
Check gemmCheck(const Problem& problem);
RACE_OURS(gemm);

Problem scanProblem(int log2);
Check scanCheck(const Problem& problem);
RACE_OURS(scan);

Problem compactionProblem(int log2);
Check compactionCheck(const Problem& problem);
RACE_OURS(compaction);

Problem sortProblem(int log2);
Check sortCheck(const Problem& problem);
RACE_OURS(sort);
Check sortPairsCheck(const Problem& problem);
RACE_OURS(sortPairs);

Problem bodiesProblem(int log2);
Check bodiesCheck(const Problem& problem);
RACE_OURS(bodies);

Problem fourierProblem(int log2);
Check fourierCheck(const Problem& problem);
RACE_OURS(fourier);

Problem reactionProblem(int log2);
Check reactionCheck(const Problem& problem);
RACE_OURS(reaction);

Problem boilingProblem(int log2);
Check boilingCheck(const Problem& problem);
RACE_OURS(boiling);
Problem convectionProblem(int log2);
Check convectionCheck(const Problem& problem);
RACE_OURS(convection);
Problem reactionStepProblem(int log2);
Check reactionStepCheck(const Problem& problem);
RACE_OURS(reactionStep);

Problem clothProblem(int log2);
Check clothCheck(const Problem& problem);
RACE_OURS(cloth);

Problem residualProblem(int log2);
Check residualCheck(const Problem& problem);
RACE_OURS(residual);
std::unique_ptr<Task> residualInTwoCalls(sk::Device& device, const sk::CallOptions& options,
                                         const Problem& problem);

Check heatLoopCheck(const Problem& problem);
RACE_OURS(heatLoop);
RACE_CALLS(heatLoop);
Problem reactionLoopProblem(int log2);
Check reactionLoopCheck(const Problem& problem);
RACE_OURS(reactionLoop);
RACE_CALLS(reactionLoop);
Check waveLoopCheck(const Problem& problem);
RACE_OURS(waveLoop);
RACE_CALLS(waveLoop);
Check chainCheck(const Problem& problem);
RACE_OURS(chain);
RACE_OURS(pipeline);
std::unique_ptr<Task> chainInOneKernel(sk::Device& device, const sk::CallOptions& options,
                                       const Problem& problem);

Problem sparseProblem(int log2);
Check sparseCheck(const Problem& problem);
RACE_OURS(sparse);
Problem powerLawProblem(int log2);
Check powerLawCheck(const Problem& problem);

Problem diagonalsProblem(int log2);
RACE_OURS(diagonals);
Problem gradientsProblem(int log2);
Check gradientsCheck(const Problem& problem);
RACE_OURS(gradients);
Problem nestedProblem(int log2);
Check nestedCheck(const Problem& problem);
RACE_OURS(nested);
Problem cycledProblem(int log2);
Check cycledCheck(const Problem& problem);
RACE_OURS(cycled);

Problem hallPrimaryProblem(int log2);
Problem hallDiffuseProblem(int log2);
Problem meshPrimaryProblem(int log2);
Problem meshDiffuseProblem(int log2);
Check hallCheck(const Problem& problem);
Check meshCheck(const Problem& problem);
RACE_OURS(hall);
RACE_OURS(hallOther);
RACE_OURS(mesh);
RACE_OURS(meshOther);

#undef RACE_OURS
#undef RACE_CALLS

}  // namespace race
