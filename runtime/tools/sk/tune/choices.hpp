// SPDX-License-Identifier: MIT
//
// Which choices a program has: what its kernels and streams can be set to, and why the rest is left out.
#pragma once

#include <string>
#include <vector>

#include "results/results_file.hpp"
#include "tune/setting.hpp"

namespace sk_tool::tune {

/// Choices that are made together.
struct Step {
  Setting changes;
  std::string of;  ///< the kernel, or the stream; "*" for streams without a name
  bool isKernel = true;
  double seconds = 0;  ///< of the kernel; of a stream, a share of all by its size
};

struct Choices {
  /// Other values of one key each, the costliest kernels first: they may be faster.
  std::vector<Step> others;
  /// All that makes a kernel or a stream as exact as it can be, the costliest last.
  std::vector<Step> raised;
  std::vector<std::string> untried;  ///< what is left out, and why
  ProgramFacts facts;
};

/// Kernels that take less than this part of the time are not tried for speed.
inline constexpr double leastShare = 0.01;

/// The choices of a program, whose run has the times of its kernels.
Choices choicesOf(const sk::results::Process& run);

}  // namespace sk_tool::tune
