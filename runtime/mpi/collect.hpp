// SPDX-License-Identifier: MIT
//
// Bytes of all elements of a domain between the host memory of one rank and that of all: what they hold is not known here.
#pragma once

#include <cstddef>
#include <vector>

#include "domain_state.hpp"

namespace sk::mpi {

/// The elements of all ranks on one of them: a collective step in two parts, so
/// that all can refuse it in between.
class Collection {
 public:
  /// For elements of `size` bytes. Allocates what this rank needs.
  Collection(const DomainState& domain, int root, std::size_t size);

  /// Collective: copies the elements of all ranks to `all` on the root, in
  /// row-major order. `own` holds this rank's.
  void collect(std::vector<std::byte> own, void* all);
  /// Collective: returns this rank's elements, of those that the root gives in
  /// row-major order.
  std::vector<std::byte> distribute(const void* all);

 private:
  const DomainState& domain_;
  int root_;
  std::size_t size_;
  std::vector<std::byte> own_,
      part_;  ///< this rank's, and on the root those of each other rank in turn
  Messages messages_;
};

}  // namespace sk::mpi
