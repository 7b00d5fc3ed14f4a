// SPDX-License-Identifier: MIT
//
// Each program in OpenCL C.
#pragma once

#include <memory>

#include "contender.hpp"

namespace race {

std::unique_ptr<Task> saxpyOpenCl(const Problem& problem);
std::unique_ptr<Task> sumOpenCl(const Problem& problem);
std::unique_ptr<Task> compensatedSumOpenCl(const Problem& problem);
std::unique_ptr<Task> dotOpenCl(const Problem& problem);
std::unique_ptr<Task> heatOpenCl(const Problem& problem);
std::unique_ptr<Task> binomialOpenCl(const Problem& problem);
std::unique_ptr<Task> mandelbrotOpenCl(const Problem& problem);
std::unique_ptr<Task> gemvOpenCl(const Problem& problem);
std::unique_ptr<Task> gemmOpenCl(const Problem& problem);
std::unique_ptr<Task> scanOpenCl(const Problem& problem);
std::unique_ptr<Task> sortOpenCl(const Problem& problem);
std::unique_ptr<Task> bodiesOpenCl(const Problem& problem);
std::unique_ptr<Task> fourierOpenCl(const Problem& problem);
std::unique_ptr<Task> reactionOpenCl(const Problem& problem);
std::unique_ptr<Task> sparseOpenCl(const Problem& problem);

}  // namespace race
