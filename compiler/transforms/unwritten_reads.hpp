// SPDX-License-Identifier: MIT
//
// Finds reads of outputs that no path has written by then:
//
//   kernel void f(float x<>, out float r<>) { r += 2 * x; }   // reads r, at the '+='
//
// A write anywhere above, or in a loop around the read, counts for all of its variable, so that what is found is a mistake
// for certain. check_outputs.hpp finds what is not written at the end.
#pragma once

#include <map>
#include <vector>

#include "ir/ir.hpp"

namespace skc {

/// InOut parameters of a function that it reads first, and where.
using UnwrittenReads = std::map<ir::VarId, Loc>;

/// For each function of the module.
std::vector<UnwrittenReads> unwrittenReads(const ir::Module& module);

}  // namespace skc
