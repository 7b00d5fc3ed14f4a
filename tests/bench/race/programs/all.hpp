// SPDX-License-Identifier: MIT
//
// The functions of all programs, which the table in programs.cpp is made of.
#pragma once

#include "programs.hpp"

namespace race {

#define RACE_OURS(name) \
  std::unique_ptr<Task> name##Ours(sk::Device& device, const sk::CallOptions& options, const Problem& problem)

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

Problem stencilProblem(int log2);
Check heatCheck(const Problem& problem);
RACE_OURS(heat);
Check binomialCheck(const Problem& problem);
RACE_OURS(binomial);

Check mandelbrotCheck(const Problem& problem);
RACE_OURS(mandelbrot);

#undef RACE_OURS

}  // namespace race
