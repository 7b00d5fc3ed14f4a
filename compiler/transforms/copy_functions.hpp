// SPDX-License-Identifier: MIT
//
// Copies functions for further variants of a kernel: after specialize-gathers each function belongs to one
// kernel, so each variant needs its own.
#pragma once

#include <map>

#include "ir/ir.hpp"

namespace skc {

/// Maps the functions copied for one variant to their copies.
using FunctionCopies = std::map<ir::FunctionId, ir::FunctionId>;

/// Copies a function after the functions that it calls.
ir::FunctionId copyFunction(ir::Module& module, ir::FunctionId id, FunctionCopies& copies);

/// Removes the tables of copied functions, for variants whose precision differs from the tables'.
void dropTables(ir::Module& module, const FunctionCopies& copies);

}  // namespace skc
