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
  domain::Depth depth;  ///< what it reads around each element
};

/// The arguments that are spread over the ranks of `domain`. Throws sk::Error, which names the kernel, the parameter and a
/// way out, if the kernel cannot run on parts of a domain with these arguments.
std::vector<SpreadArgument> spreadArguments(const DomainState& domain, const program::Kernel& kernel,
                                            std::span<const Argument> arguments);

}  // namespace sk::mpi
