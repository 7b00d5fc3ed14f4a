// SPDX-License-Identifier: MIT
//
// Copies of functions for the further forms of a kernel: after specialize-gathers each function belongs to one kernel,
// so that a form has its own.
#pragma once

#include <map>

#include "ir/ir.hpp"

namespace skc {

/// What has been copied for one form, and to what.
using FunctionCopies = std::map<ir::FunctionId, ir::FunctionId>;

/// A copy of a function, made behind copies of those that it calls.
ir::FunctionId copyFunction(ir::Module& module, ir::FunctionId id, FunctionCopies& copies);

/// Copies compute what a table might stand for: those of forms in other precisions than the table's.
void dropTables(ir::Module& module, const FunctionCopies& copies);

}  // namespace skc
