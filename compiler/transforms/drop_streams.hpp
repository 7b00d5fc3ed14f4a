// SPDX-License-Identifier: MIT
//
// Functions that are no entries have no parameters that are streams once specialize-gathers has run: GLSL has none.
#pragma once

#include "ir/ir.hpp"

namespace skc {

/// A parameter that goes.
bool isDropped(const ir::Variable& var);

/// Takes them out of a function whose body does not name them any more; elements become values.
void dropStreams(ir::Function& function);

}  // namespace skc
