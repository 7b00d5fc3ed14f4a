// SPDX-License-Identifier: MIT
//
// inline-folds: writes the helper functions and kernels by which a reduce folds into its body, where that shows the
// operator, so that what a fold means does not depend on who wrote it down.
//
//   before   float join(float a, float e, float c) { return a + e + c; }
//            reduce void bar(float a<>, float c, reduce float e<>) { e = join(a, e, c); }
//   after    reduce void bar(float a<>, float c, reduce float e<>) { e = a + e + c; }
//
// A reduce whose fold does not become known stays as it is.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void inlineFolds(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
