// SPDX-License-Identifier: MIT
//
// How many iterations the loops of a kernel take together.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/ir.hpp"

namespace skc::analysis {

/// A bound of the iterations of all loops for one element, including those of library functions for integers of 64 bits; nullopt
/// if a loop has no constant trip count, or for more than 2^20. Both sides of a branch count, because elements that are
/// computed together take both.
std::optional<std::int64_t> mostIterations(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::analysis
