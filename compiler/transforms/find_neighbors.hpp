// SPDX-License-Identifier: MIT
//
// find-neighbors: a gather that is read at the current index plus constants is read at a neighbour, of which is known how far
// away it is: aligned texels, packed outputs and contiguous loads follow. Both mean the same for every boundary mode and every shape of
// the gather, because an offset counts from the index of the domain.
//
//   before   int2 p = indexof(r).xy;  r = a[p.y + 1][p.x - 1];
//   after    int2 p = indexof(r).xy;  r = neighbor(a, -1, 1);
//
// Not in a reduce, whose result is smaller than the domain of its neighbours.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void findNeighbors(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
