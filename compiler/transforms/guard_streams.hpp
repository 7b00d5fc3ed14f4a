// SPDX-License-Identifier: MIT
//
// guard-streams: finds for each stream of a kernel the values of the spec parameters for which the kernel
// uses it, from the branches around its uses. It changes no function.
//
//   kernel   f: entry @0                           f: entry @0
//              $0 bent: spec bool                    $0 bent: spec bool
//              $1 light: gather float rank 1         $1 light: gather float rank 1 if bent
//              $2 r: output float                    $2 r: output float
//   body     r = bent ? $1[0] : 0.0;
//
// What it cannot analyse counts as a use: a condition may be true too often, never false for a used stream.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void guardStreams(ir::Module& module, Diagnostics& diagnostics);

/// True if `expr` consists of literals, constants and variables that `isSpec` marks.
bool isSpecOnly(const ir::Expr& expr, const std::vector<bool>& isSpec);

}  // namespace skc
