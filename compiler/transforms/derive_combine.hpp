// SPDX-License-Identifier: MIT
//
// derive-combine: says for each reduce how partial results combine, which every parallel fold needs.
//
//   before   reduce void sumSquares(float x<>, reduce float total<>) { total += x * x; }
//   after    the same, with identity 0 and
//            reduce void sumSquares_combine(float total_part<>, reduce float total<>) { total += total_part; }
//
// Cases, in this order:
//   * The author wrote an overload that folds accumulators: it stays.
//   * The body folds by known operators (fold_pattern.hpp). `total += x` on x itself combines by
//     itself; any other gets a reduce `accumulator op= part`, member by member. Subtraction and
//     division are errors: partial results of them do not combine.
//   * The elements' and the accumulators' types are the same, one by one: the reduce combines by itself,
//     since the language demands that the operation is associative.
//   * Otherwise the author has to write that overload.
// What combines may not ask where an element is: a partial result is nowhere.
//
// Identities and -0. Where the author gives an identity, every run of elements starts from it, as the
// text says: the sum of a stream of -0 with `= 0` is 0 + -0 = +0, as in C++, and `max` with `= -inf`
// drops NaN where the device's max does. Where he gives none, the fold starts with its first element
// (`seeded`): the sum of -0 is -0, and one NaN stays NaN. An identity is then supplied for what the
// operator knows, so that an empty stream has a value; +0 for sums, the value that IEEE 754-2019
// 9.4 gives an empty sum, although -0 would be the neutral element. Where the fold cannot start with
// an element (x * x, or another type), runs start with the supplied identity, and a sum of nothing
// but -0 gives +0.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void deriveCombine(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
