// SPDX-License-Identifier: MIT
//
// The exchange of halos: one message to each neighbor, with the halos of all
// streams of a call. Whatever fails on this rank, its neighbors get a message
// in the place of each that they wait for.
//
// A Carrier is how halos get from a device to messages, and from messages to a device: in the streams' own memory on native devices, through
// staging memory on GL devices that have compute programs, and as elements on others.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "domain_state.hpp"

namespace sk::mpi {

/// What goes to, and comes from, one neighbor.
struct Strips {
  std::size_t direction;  ///< in DomainState::directions
  std::vector<StreamRegion> sent,
      received;  ///< boxes of streams, in the order of their bytes
  std::size_t sentBytes = 0, receivedBytes = 0;
};

/// The halos of one exchange. `strips` must outlive it.
class Carrier {
 public:
  /// Makes the carrier that suits the devices of all ranks, with all host
  /// memory that it needs.
  static std::unique_ptr<Carrier> of(DomainState& domain, std::span<Strips> strips);

  virtual ~Carrier() = default;
  Carrier(const Carrier&) = delete;
  Carrier& operator=(const Carrier&) = delete;

  /// Whether what is sent is in host memory from the beginning, so that it need not wait for a device.
  virtual bool isAtHost() const = 0;
  /// Where what comes from a neighbor is received.
  virtual std::byte* target(const Strips& neighbor) noexcept = 0;
  /// Begins to pack what is sent.
  virtual void begin() = 0;
  /// What is sent to a neighbor, of each in turn; waits until it is packed.
  /// Throws sk::Error if the device cannot pack it.
  virtual const std::byte* source(const Strips& neighbor) = 0;
  /// Stores what has been received, all of it.
  virtual void store() = 0;

 protected:
  Carrier(DomainState& domain, std::span<Strips> strips) : domain_(domain), strips_(strips) {}

  DomainState& domain_;
  const std::span<Strips> strips_;
};

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
