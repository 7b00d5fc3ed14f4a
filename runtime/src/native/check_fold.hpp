// SPDX-License-Identifier: MIT
//
// SK_CHECK=folds: tries what the author of a reduce promises, on elements of each call that are chosen at random: that the
// fold is associative, that what a run starts from is neutral, and that partial results combine to what folding their elements
// one after the other gives.
#pragma once

#include "native/call.hpp"
#include "native/entries.hpp"
#include "native/fold_program.hpp"
#include "sk/program.hpp"

namespace sk {

/// Throws sk::Error, which names the reduce and shows the values, where one of these does not hold: integers are compared
/// exactly, floats within 2^-12 (doubles 2^-40) of the largest magnitude that the scalar had in any of the results.
void checkFold(const program::Reduction& reduction, const FoldProgram& program, const native::Call& call,
               const CodeChoice& choice);

}  // namespace sk
