// SPDX-License-Identifier: MIT
//
// fold-constants: computes what is known, and takes the branches that it decides. Careful rather
// than thorough: a value is computed only where every device would compute the same one, and names
// of constants stay, since the driver folds the rest and people read the GLSL.
//
//   before   const bool periodic = false;
//            v = (2.0 * 0.5 - 1.0) * x;  if (periodic && x > 0.0) v = wrapped(x); else v = 2.0 * pi * x;
//   after    const bool periodic = false;
//            v = 0.0 * x;  v = 2.0 * pi * x;
//
// A component of a vector with a known number gets its name, `a[1]` becomes `a.y`: so later transforms see what is folded
// and what is written.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void foldConstants(ir::Module& module, Diagnostics& diagnostics);

/// The same for a function into which another transform has put literals, but for arithmetic on floats, whose results stay
/// those of the device, and of the forms that compute in doubles. Locals that hold a known integer all the time, vectors of
/// integers, and elements of constant arrays are computed as well.
void foldWholeNumbers(const ir::Module& module, ir::Function& function);

}  // namespace skc
