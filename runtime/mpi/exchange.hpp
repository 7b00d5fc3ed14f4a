// SPDX-License-Identifier: MIT
//
// The exchange of halos: one message to each neighbor, with the halos of all streams of a call. Native devices send and
// receive in the streams' own memory if all that a neighbor gets is contiguous there; otherwise, elements are packed.
#pragma once

#include <memory>
#include <vector>

#include "domain_state.hpp"

namespace sk::mpi {

/// A stream whose halo is to become valid in this depth, which is allocated.
struct HaloRequest {
  DomainStreamState* stream;
  domain::Depth depth;
};

class Exchange {
 public:
  /// Posts the messages, on native devices. On others, begins to pack: calls of kernels that read no halo may follow before
  /// finish(). The elements must not be written before finish().
  Exchange(DomainState& domain, std::vector<HaloRequest> requests);
  ~Exchange();
  /// Waits for the messages, and stores the halos.
  void finish();

 private:
  struct Direction;

  void post();

  DomainState& domain_;
  std::vector<HaloRequest> requests_;
  std::vector<Direction> neighbors_;
  Messages messages_;
};

}  // namespace sk::mpi
