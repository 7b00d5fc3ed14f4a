// SPDX-License-Identifier: MIT
//
// Runs reductions that skc compiled to object code.
#pragma once

#include <cstdint>
#include <span>

#include "native/call.hpp"
#include "native/entries.hpp"
#include "sk/program.hpp"

namespace sk {

/// Folds each block of the domain to one element of the accumulators' operands. No block is empty; the fold's
/// code is not null. Throws sk::Error if it has no code that runs on this CPU.
void foldCode(const program::Reduction& reduction, const native::ReduceCall& call, const CodeChoice& choice);

/// Combines the results of `count` consecutive parts of a domain, in order. `parts` and `result` have one array for each
/// scalar of the accumulators; `combine` is the call of the reduction's `combine`.
void combineParts(const program::Reduction& reduction, const native::Call& combine, const CodeChoice& choice,
                  std::span<void* const> parts, std::int64_t count, std::span<void* const> result);

/// For an empty domain: writes the identities to the first element of the accumulators' operands.
void storeIdentities(const program::Reduction& reduction, const native::Call& call, const CodeChoice& choice);

}  // namespace sk
