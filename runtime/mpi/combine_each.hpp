// SPDX-License-Identifier: MIT
//
// Combines many results of a fold with earlier ones, element by element: natively by the reduction's own code, on GL devices by
// a reduction over blocks of two.
#pragma once

#include <cstdint>

#include "accumulators.hpp"
#include "call/resolved_call.hpp"
#include "domain_state.hpp"

namespace sk::mpi {

/// Which earlier result an element follows: number (k / (inner * length)) * inner + k % inner for element k. So lines along a
/// dimension of extent `length`, with `inner` elements after it, each have one.
struct LinesOf {
  std::int64_t length = 1, inner = 1;

  std::int64_t lineOf(std::int64_t element) const {
    return element / (inner * length) * inner + element % inner;
  }
};

/// Folds blocks of partial results of the call's reduction, in order: `parts` and `results` have one region for each
/// accumulator.
void combineAsReduction(DomainState& domain, const ResolvedReduction& call,
                        std::span<const StreamRegion> parts, std::span<const StreamRegion> results);

/// Folds each element of `later` into the earlier result that it follows, and stores the result in its place. Both have one
/// dimension. `call` gives the reduction, its arguments other than streams, and options.
void combineEach(DomainState& domain, const ResolvedReduction& call, const Accumulators& earlier,
                 Accumulators& later, const LinesOf& lines);

}  // namespace sk::mpi
