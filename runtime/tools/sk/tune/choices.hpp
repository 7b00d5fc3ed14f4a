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
  /// It is rarely faster: a precision other than float's, because wide ones take longer and half is emulated, or halves in native streams,
  /// which are floats that are rounded.
  bool isUnlikely = false;
};

struct Choices {
  /// Other values of one key each, which may be faster: the costliest kernels and streams first, and unlikely ones after all others, so
  /// that a search which the budget ends has tried what promises most.
  std::vector<Step> others;
  /// All that makes a kernel or a stream as exact as it can be, the costliest last.
  std::vector<Step> raised;
  /// All that makes a kernel or a stream of wide numbers one of floats. They are tried together, because a kernel that reads or writes
  /// numbers of another width converts them, which may cost more than it saves.
  std::vector<Step> lowered;
  std::vector<std::string> untried;  ///< what is left out, and why
  ProgramFacts facts;
};

/// Kernels that take less than this part of the time, and streams that hold less than this part of the bytes, are not tried for speed.
inline constexpr double leastShare = 0.01;

/// The choices of a program, whose run has the times of its kernels.
Choices choicesOf(const sk::results::Process& run);

}  // namespace sk_tool::tune
