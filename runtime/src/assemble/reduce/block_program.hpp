// SPDX-License-Identifier: MIT
//
// The program of a pass in which each work group folds a block of elements, or a part of one, to one result: neighbouring
// invocations read neighbouring elements, or texels, and the group combines what they have folded.
#pragma once

#include <string>

#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_program.hpp"
#include "sk/program.hpp"

namespace sk::assemble {

/// Whether a variant is of such a pass.
inline bool isByGroupsOfBlocks(const ReduceVariant& variant) {
  return variant.grouped && variant.walk == Walk::Index;
}

/// The program of one pass. Its outputs, and the values of its uniforms, are as in reduceProgram().
std::string blockProgram(const Profile& profile, const program::Reduction& reduction,
                         const ReduceVariant& variant);

}  // namespace sk::assemble
