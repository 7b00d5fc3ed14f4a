// SPDX-License-Identifier: MIT
//
// Exact sums of floats (program::ExactSum), which the runtime adds itself, of terms that are inputs, products of two, or what a
// kernel computes.
#pragma once

#include <span>
#include <vector>

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// Whether the runtime can add a sum itself.
inline bool hasTerm(const program::ExactSum& sum) {
  return sum.term.kernel != nullptr || !sum.term.factors.empty();
}

/// The kernel that a term is summed for: its own, or the fold whose inputs are its factors.
const program::Kernel& kernelOfTerm(const program::Reduction& reduction, const program::ExactSum& sum);

/// The rounded sum of each block of the domain, row-major; no block is empty. `call` is one of kernelOfTerm() whose outputs are left
/// out; the reduction's identity is added once to each. Real: that of `choice`, float, double or native::Quad.
template <class Real>
std::vector<Real> sumExactly(const program::Reduction& reduction, const program::ExactSum& sum,
                             const native::Call& call, const native::Extents& block,
                             const CodeChoice& choice);

}  // namespace sk
