// SPDX-License-Identifier: MIT
//
// The exchange of halos: one message to each neighbor, with the halos of all streams of a call.
#pragma once

#include <memory>
#include <vector>

#include "carrier.hpp"
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
  struct Neighbor {
    int rank;
    std::size_t opposite;  ///< the direction in which it sees this rank
  };

  void addNeighbor(std::size_t direction);
  void post();

  DomainState& domain_;
  std::vector<HaloRequest> requests_;
  std::vector<Neighbor> neighbors_;
  std::vector<Strips> strips_;  ///< for each neighbor
  std::unique_ptr<Carrier> carrier_;
  Messages messages_;  ///< ends before what it sends and receives
};

}  // namespace sk::mpi
