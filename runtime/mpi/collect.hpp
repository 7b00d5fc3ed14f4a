// SPDX-License-Identifier: MIT
//
// Bytes of all elements of a domain between the host memory of one rank and that of all: what they hold is not known here.
#pragma once

#include <cstddef>
#include <vector>

#include "domain_state.hpp"

namespace sk::mpi {

/// Collective: copies the elements of all ranks, of `size` bytes each, to `all` on rank `root`, in row-major order.
/// `own` holds this rank's.
void collect(const DomainState& domain, int root, std::size_t size, std::vector<std::byte> own, void* all);

/// Collective: returns this rank's elements, of those that rank `root` gives in row-major order.
std::vector<std::byte> distribute(const DomainState& domain, int root, std::size_t size, const void* all);

}  // namespace sk::mpi
