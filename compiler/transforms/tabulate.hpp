// SPDX-License-Identifier: MIT
//
// Tables of functions: gives each table that some kernel may use a kernel that computes its function, from
// which the runtime fills the table. Calls are not changed: the assembler turns them into look-ups.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void tabulate(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
