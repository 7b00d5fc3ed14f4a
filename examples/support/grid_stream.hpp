// SPDX-License-Identifier: MIT
//
// The streams of a grid, which are on one device or divided over the ranks of MPI, are those of the solvers. joinRanks() makes what is divided.
#pragma once

#include "linear/grid_stream.hpp"

namespace examples {

using sk::linear::DividedGrid;
using sk::linear::DividedStream;
using sk::linear::Gathered;
using sk::linear::GridStream;
using sk::linear::Space;

}  // namespace examples
