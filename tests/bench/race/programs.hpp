// SPDX-License-Identifier: MIT
//
// The programs that are raced, a row each: what they compute of how many elements, what that costs at least, how it is
// checked, and how the runtime does it. A program's file in programs/ holds its functions.
#pragma once

#include <memory>
#include <vector>

#include <sk/sk.hpp>

#include "check.hpp"
#include "contender.hpp"
#include "problems.hpp"

namespace race {

/// The work of a problem of n elements, as an algorithm that wastes nothing has it.
struct Work {
  double operations;  ///< of floats; 0 where there are none to speak of
  double bytes;  ///< read and written once
  double passes = 1;  ///< over the same memory, whose bytes are counted in each
};

using MakeOurs = std::unique_ptr<Task> (*)(sk::Device& device, const sk::CallOptions& options,
                                           const Problem& problem);

struct Program {
  const char* name;
  const char* element;  ///< what a size counts
  std::vector<int> sizes;  ///< their logarithms to base 2, where nothing else is asked for
  std::vector<int> ownSizes;  ///< further ones, where only ours show how their cost grows
  Work (*work)(double n);
  Problem (*problem)(int log2);
  Check (*check)(const Problem& problem);
  MakeOurs ours;
  const char* variantName = nullptr;  ///< another way that we do it, raced beside the first; none, as a rule
  MakeOurs variant = nullptr;
  bool isContractionRaced =
      false;  ///< native code that may fuse multiply-adds is raced as well: most compilers of peers fuse them
};

const std::vector<Program>& programs();

}  // namespace race
