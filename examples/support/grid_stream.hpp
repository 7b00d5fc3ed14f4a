// SPDX-License-Identifier: MIT
//
// The streams of a grid, which are on one device or divided over the ranks of MPI, are those of the solvers. joinRanks() makes what is divided.
#pragma once

#include <string_view>

#include "linear/grid_stream.hpp"

namespace examples {

using sk::linear::DividedGrid;
using sk::linear::DividedStream;
using sk::linear::Gathered;
using sk::linear::GridStream;
using sk::linear::Space;

/// A stream of a space with a name, by which a configuration file chooses its storage if `storage` is the default. A stream that is divided
/// over ranks has no name.
template <class T>
GridStream<T> namedStream(const Space& space, sk::Storage storage, std::string_view name) {
  if (space.isDivided()) return space.stream<T>(storage);
  return {space.device().stream<T>(space.shape(), storage, name), storage};
}

}  // namespace examples
