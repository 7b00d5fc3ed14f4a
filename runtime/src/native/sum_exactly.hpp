// SPDX-License-Identifier: MIT
//
// Exact sums of floats (program::ExactSum) that the runtime computes itself. Their terms are inputs, products
// of two inputs, or what a kernel computes.
#pragma once

#include <span>
#include <vector>

#include "call/row_pieces.hpp"
#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// True if the runtime can compute a sum itself.
inline bool hasTerm(const program::ExactSum& sum) {
  return sum.term.kernel != nullptr || !sum.term.factors.empty();
}

/// The kernel whose call sumExactly() gets: that of the term or, if its factors are inputs, the fold.
const program::Kernel& kernelOfTerm(const program::Reduction& reduction, const program::ExactSum& sum);

/// The rounded sum of each block of the domain, row-major; no block is empty. Each sum includes the
/// reduction's identity once. `call` is a call of kernelOfTerm() with all outputs omitted. Real is the type of
/// `choice`: float, double or native::Quad.
template <class Real>
std::vector<Real> sumExactly(const program::Reduction& reduction, const program::ExactSum& sum,
                             const native::Call& call, const native::Extents& block,
                             const CodeChoice& choice);

/// The sum of the whole domain, not rounded (ExactAccumulator::words). It includes the reduction's identity if `isFirst`.
std::vector<std::int64_t> exactWords(const program::Reduction& reduction, const program::ExactSum& sum,
                                     const native::Call& call, const CodeChoice& choice, bool isFirst);

/// Likewise, of each row of a one-dimensional domain. A row without elements has the reduction's identity.
template <class Real>
std::vector<Real> sumRowsExactly(const program::Reduction& reduction, const program::ExactSum& sum,
                                 const native::Call& call, const RowPieces& rows, const CodeChoice& choice);

}  // namespace sk
