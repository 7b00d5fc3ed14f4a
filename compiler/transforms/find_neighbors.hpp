// SPDX-License-Identifier: MIT
//
// find-neighbors: turns a gather at the current index plus constants into a read of a neighbour, whose
// distance is known: this enables aligned texels, packed outputs and contiguous loads. Both mean the same for
// every boundary mode and shape of the gather, because a neighbour's offset is relative to the domain's
// index.
//
//   before   int2 p = indexof(r).xy;  r = a[p.y + 1][p.x - 1];
//   after    int2 p = indexof(r).xy;  r = neighbor(a, -1, 1);
//
// It skips reduces, whose result is smaller than the domain of their neighbours.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void findNeighbors(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
