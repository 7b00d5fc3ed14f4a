// SPDX-License-Identifier: MIT
//
// The ways in which a reduction adds floats, beside the plain one: variants of it, each with a kernel that computes
// results from accumulators.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sk/program.hpp"

namespace skc::web {

/// One variant, and the kernel that runs over its results.
struct SumVariant {
  const sk::program::Reduction* reduction;
  const sk::program::Kernel* finish;
  /// For each Input of `finish`: an accumulator of the variant if `isOwn`, else of the plain reduction.
  struct Input {
    bool isOwn;
    std::uint8_t index;
  };
  std::vector<Input> inputs;
  std::vector<std::uint8_t> results;  ///< the accumulators of the plain reduction that `finish` computes
};

/// What `with({ accumulate: 'exact' })` runs.
struct SumVariants {
  std::string_view name;  ///< 'exact'
  std::vector<SumVariant> variants;  ///< one after the other
  std::string whyNot = {};  ///< why no browser runs it; then there are no variants
  bool isRare = false;  ///< calls ask for it; few programs are worth more than fast ones
};

/// The choices that a reduction has. Those that make no difference to it are left out.
std::vector<SumVariants> sumVariants(const sk::program::Reduction& reduction, bool scans);

/// Whether every scalar of every accumulator is an exact sum, so that the plain fold is not needed.
bool sumsEverything(const sk::program::Reduction& reduction);

/// Whether elements are always found by their index.
bool findsByIndex(const sk::program::Reduction& reduction);

/// Why the passes of a reduction read more planes than browsers guarantee; "" if they do not.
std::string whyTooManyPlanes(const sk::program::Reduction& reduction, bool scans);

}  // namespace skc::web
