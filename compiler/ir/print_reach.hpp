// SPDX-License-Identifier: MIT
//
// A gather's reach as text, for people.
#pragma once

#include <string>

#include "ir/ir.hpp"

namespace skc::ir {

/// The offsets between which a kernel reads a gather in each dimension, as "x -1 to 2, y 0, z whole". A bound that
/// depends on Spec parameters names them; a promise is mentioned.
std::string printReach(const Kernel& kernel, const KernelParam& param);

}  // namespace skc::ir
