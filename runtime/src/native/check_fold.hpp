// SPDX-License-Identifier: MIT
//
// SK_CHECK=folds: checks what the author of a reduction promises, on random elements of each call: that the
// fold is associative, that its initial value is neutral, and that combining partial results gives the same
// as folding their elements one after the other.
#pragma once

#include "native/call.hpp"
#include "native/entries.hpp"
#include "native/fold_program.hpp"
#include "sk/program.hpp"

namespace sk {

/// Throws sk::Error, which names the reduction and shows the values, if one of these does not hold. Integers
/// are compared exactly, floats within 2^-12 (doubles 2^-40) of the largest magnitude of the scalar in any of
/// the results.
void checkFold(const program::Reduction& reduction, const FoldProgram& program, const native::Call& call,
               const CodeChoice& choice);

}  // namespace sk
