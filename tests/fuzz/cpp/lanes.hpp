// SPDX-License-Identifier: MIT
//
// Runs a program's IR without any code: element by element as it is, then several elements at once after `predicate`, one per
// lane, where values must have the shapes that the analysis gives them.
#pragma once

#include <string>
#include <vector>

#include "cpp/samples.hpp"
#include "ir/ir.hpp"

namespace fuzz::cpp {

/// The first difference to what is wanted, or "". Takes the output of runTransforms.
std::string differenceOfLanes(const skc::ir::Module& module, const std::vector<Outputs>& wanted);

}  // namespace fuzz::cpp
