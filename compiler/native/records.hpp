// SPDX-License-Identifier: MIT
//
// What the runtime is to know of the records of a kernel's variable and scatter outputs (sk/native/code.hpp).
#pragma once

#include "ir/ir.hpp"

namespace skc::native {

/// True if a group of lanes may record more than once for one output. The lanes of one statement are in order; those of a
/// second are behind all of the first.
bool isReordered(const ir::Module& module, const ir::Kernel& kernel);

/// True if an element is computed in less time than it takes to keep and carry out a record.
bool isLight(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::native
