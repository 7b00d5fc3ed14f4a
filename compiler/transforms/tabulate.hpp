// SPDX-License-Identifier: MIT
//
// Tables of functions: gives each that some kernel may look up a kernel that computes the function, of which the runtime
// makes the table. Calls stay what they are: it is the assembler that makes look-ups of them.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void tabulate(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
