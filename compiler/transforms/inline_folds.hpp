// SPDX-License-Identifier: MIT
//
// inline-folds: inlines the helper functions and kernels through which a reduce folds, if that reveals the
// operator. The meaning of a fold then does not depend on how its code is divided into functions.
//
//   before   float join(float a, float e, float c) { return a + e + c; }
//            reduce void bar(float a<>, float c, reduce float e<>) { e = join(a, e, c); }
//   after    reduce void bar(float a<>, float c, reduce float e<>) { e = a + e + c; }
//
// A reduce whose operator stays unknown is not changed.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void inlineFolds(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
