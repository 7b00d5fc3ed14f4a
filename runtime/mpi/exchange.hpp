// SPDX-License-Identifier: MIT
//
// The exchange of halos: one message to each neighbor, with the halos of all
// streams of a call. Whatever fails on this rank, its neighbors get a message
// in the place of each that they wait for.
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
  /// Makes ready all that may fail, and begins to pack on devices other than
  /// native ones. Posts nothing. The elements must not be written before
  /// finish().
  Exchange(DomainState& domain, const std::vector<HaloRequest>& requests);
  /// Completes what start() has begun.
  ~Exchange();
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  /// Posts the messages that are ready: on native devices, all. Every rank
  /// does. Calls of kernels that read no halo may follow before finish().
  void start();
  /// Waits for the messages, and stores the halos. Throws sk::Error if this
  /// rank or a neighbor could not pack, after all messages.
  void finish();

 private:
  struct Neighbor {
    int rank;
    std::size_t opposite;  ///< the direction in which it sees this rank
  };
  enum class Progress : std::uint8_t { Ready, Started, Sent, Complete };

  void addNeighbor(std::size_t direction, const std::vector<HaloRequest>& requests);
  void sendAll();
  template <class Post>
  void post(Post&& post);

  DomainState& domain_;
  std::vector<Neighbor> neighbors_;
  std::vector<Strips> strips_;  ///< for each neighbor
  std::unique_ptr<Carrier> carrier_;
  Messages messages_;  ///< ends before what it sends and receives
  Progress progress_ = Progress::Ready;
  Refusal failure_;  ///< why this rank could not pack or post all
};

}  // namespace sk::mpi
