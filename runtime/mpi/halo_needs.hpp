// SPDX-License-Identifier: MIT
//
// How deep a halo a call needs around each stream of a domain, and whether its arguments can be divided at all.
#pragma once

#include <span>
#include <vector>

#include "domain_state.hpp"

namespace sk::mpi {

/// A stream of a domain that a kernel reads or writes.
struct SpreadArgument {
  std::size_t index;  ///< of the argument
  DomainStreamState* stream;
  bool isWritten;
  bool isGather;
  /// What it reads around each element; of a stream of another domain, what this needs around the elements of a rank.
  domain::Depth depth;
};

/// The arguments that are spread over the ranks of `domain`, which the call computes, and gathers that are of other domains with
/// the same device. Throws sk::Error, which names the kernel, the parameter and a
/// way out, if the kernel cannot run on parts of a domain with these arguments.
std::vector<SpreadArgument> spreadArguments(const DomainState& domain, const program::Kernel& kernel,
                                            std::span<const Argument> arguments);

}  // namespace sk::mpi
