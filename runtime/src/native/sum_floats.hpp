// SPDX-License-Identifier: MIT
//
// Sums of floats, or of products of two, in doubles; most sums of floats are computed this way
// (program::SumTerm). The runtime adds them itself, in the same order as other reductions.
#pragma once

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// True if a call in doubles only sums the contents of float streams.
bool sumsFloats(const program::Reduction& reduction, const native::Call& fold, const CodeChoice& choice);

/// Sums each block of the domain to one element of the accumulator's operand, or scans it. No block is empty.
void sumFloats(const program::Reduction& reduction, const native::ReduceCall& call, const CodeChoice& choice);

}  // namespace sk
