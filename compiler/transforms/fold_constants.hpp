// SPDX-License-Identifier: MIT
//
// fold-constants: computes what is known, and removes branches that are never taken. It prefers safety to
// completeness: a value is computed only if every device would compute the same one, and constants keep their
// names, since the driver folds the rest and people read the GLSL.
//
//   before   const bool periodic = false;
//            v = (2.0 * 0.5 - 1.0) * x;  if (periodic && x > 0.0) v = wrapped(x); else v = 2.0 * pi * x;
//   after    const bool periodic = false;
//            v = 0.0 * x;  v = 2.0 * pi * x;
//
// A vector's component with a known index gets its name, `a[1]` becomes `a.y`, so that later transforms treat
// folded and written components alike.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void foldConstants(ir::Module& module, Diagnostics& diagnostics);

/// The same for a function into which another transform has substituted literals, except for float
/// arithmetic, whose results must stay those of the device, and of the variants in double. It also computes
/// locals that always hold a known integer, integer vectors, and elements of constant arrays.
void foldWholeNumbers(const ir::Module& module, ir::Function& function);

}  // namespace skc
