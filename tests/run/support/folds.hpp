// SPDX-License-Identifier: MIT
//
// The expected results of reduces: plain left-to-right folds of an array, or of its blocks.
#pragma once

#include <string>
#include <vector>

#include "support/host_array.hpp"
#include "support/values.hpp"

namespace run_tests {

/// Integers from -8 to 7, whose sums are exact in any order.
inline float smallAt(std::size_t i) {
  return static_cast<float>(hashed(static_cast<std::uint32_t>(i)) % 16u) - 8;
}

/// Folds the elements of a box of `input`, which starts at `begin` and has shape `box`, in row-major order.
template <class A, class T, class Fold>
A foldBox(const HostArray<T>& input, const Position& begin, const sk::Shape& box, A accumulator,
          const Fold& fold) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(box.size()); ++i) {
    Position p = positionOf(box, i);
    for (std::size_t d = 0; d < 4; ++d) p[d] += begin[d];
    fold(accumulator, input[p]);
  }
  return accumulator;
}

/// The fold of each block of `input`, for an output whose extents divide the input's.
template <class A, class T, class Fold>
HostArray<A> foldBlocks(const HostArray<T>& input, const sk::Shape& output, const A& identity,
                        const Fold& fold) {
  sk::Shape block = input.shape();
  for (int d = 0; d < block.rank(); ++d) block = block.with(d, block[d] / output[d]);
  return HostArray<A>(output, [&](std::size_t i) {
    Position begin = positionOf(output, i);
    for (int d = 0; d < block.rank(); ++d) begin[static_cast<std::size_t>(d)] *= block[d];
    return foldBox(input, begin, block, identity, fold);
  });
}

}  // namespace run_tests
