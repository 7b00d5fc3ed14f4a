// SPDX-License-Identifier: MIT
//
// What the runtime must know about the records of a kernel's variable and scatter outputs
// (sk/native/code.hpp).
#pragma once

#include "ir/ir.hpp"

namespace skc::native {

/// True if a group of lanes may append records more than once for one output. The records of one statement
/// are in the order of lanes, but all of them precede those of the next statement.
bool isReordered(const ir::Module& module, const ir::Kernel& kernel);

/// True if computing an element takes less time than storing a record and carrying it out.
bool isLight(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::native
