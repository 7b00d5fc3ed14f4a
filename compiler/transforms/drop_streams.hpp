// SPDX-License-Identifier: MIT
//
// After specialize-gathers, only entries have stream parameters, because GLSL functions cannot have any.
#pragma once

#include "ir/ir.hpp"

namespace skc {

/// True for a parameter to be removed.
bool isDropped(const ir::Variable& var);

/// Removes stream parameters from a function whose body no longer uses them; elements become values.
void dropStreams(ir::Function& function);

}  // namespace skc
