// SPDX-License-Identifier: MIT
//
// Finds reads of outputs that no path has written before:
//
//   kernel void f(float x<>, out float r<>) { r += 2 * x; }   // reads r, at the '+='
//
// Any write above the read, or in a loop around it, counts for the whole variable, so that every finding is
// certainly a mistake. check_outputs.hpp finds outputs that are not written at the end.
#pragma once

#include <map>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// The InOut parameters of a function that it reads before writing, and where.
using UnwrittenReads = std::map<ir::VarId, Loc>;

/// The result for each function of the module.
std::vector<UnwrittenReads> unwrittenReads(const ir::Module& module);

}  // namespace skc
