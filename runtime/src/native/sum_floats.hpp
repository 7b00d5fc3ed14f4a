// SPDX-License-Identifier: MIT
//
// Sums of floats, or of products of two, in doubles: what most sums of floats come to (program::SumTerm). The runtime adds them
// itself, in the order of all other reductions.
#pragma once

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether a call in doubles only sums what streams of floats hold.
bool sumsFloats(const program::Reduction& reduction, const native::Call& fold, const CodeChoice& choice);

/// Sums each block of the domain to one element of the accumulator's operand. No block is empty.
void sumFloats(const program::Reduction& reduction, const native::ReduceCall& call, const CodeChoice& choice);

}  // namespace sk
