// SPDX-License-Identifier: MIT
//
// expand-selects: `?:` of structs, of arrays and of doubles, which may be pairs of floats, becomes a branch. WebGL
// forbids it ("ternary operator is not allowed for structures"); only the profile webgl2 needs this.
//
//   best = h.t < best.t ? h : best;      Hit chosen;
//                                        if (h.t < best.t) chosen = h; else chosen = best;
//                                        best = chosen;
//
// Either side is evaluated only where it was before. A choice by component, as between two double2, stays: the
// assembler defines it for each component.
#pragma once

#include "ir/ir.hpp"

namespace skc {

void expandSelects(ir::Module& module);

}  // namespace skc
