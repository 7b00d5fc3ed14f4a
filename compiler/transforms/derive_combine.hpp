// SPDX-License-Identifier: MIT
//
// derive-combine: determines how the partial results of each reduce combine, which every parallel fold needs.
//
//   before   reduce void sumSquares(float x<>, reduce float total<>) { total += x * x; }
//   after    the same, with identity 0 and
//            reduce void sumSquares_combine(float total_part<>, reduce float total<>) { total += total_part; }
//
// Cases, in this order:
//   * The author wrote an overload that folds accumulators: it stays.
//   * The body folds by known operators (fold_pattern.hpp). `total += x` on x itself combines its own
//     results; any other gets a reduce `accumulator op= part`, member by member. Subtraction and
//     division are errors: their partial results do not combine.
//   * The elements and the accumulators have the same types, one by one: the reduce combines its own
//     results, since the language requires the operation to be associative.
//   * Otherwise the author has to write that overload.
// A combining reduce must not ask where an element is: a partial result has no index. All folds are then tried on
// numbers (try_fold.hpp), so that no result depends on how the device divides the elements, but for rounding.
//
// Identities and -0. If the author gives an identity, every run of elements starts from it, as written: the
// sum of a stream of -0 with `= 0` is 0 + -0 = +0, as in C++, and `max` with `= -inf` drops NaN wherever the
// device's max does. Otherwise the fold starts with its first element (`seeded`): the sum of -0 is -0, and
// one NaN stays NaN. An identity is then supplied for known operators, so that an empty stream has a value;
// for sums it is +0, the value that IEEE 754-2019 9.4 gives an empty sum, although -0 would be the neutral
// element. If the fold cannot start with an element (x * x, or another type), runs start with the supplied
// identity, and a sum of only -0 gives +0.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void deriveCombine(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
