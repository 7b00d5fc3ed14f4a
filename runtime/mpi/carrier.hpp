// SPDX-License-Identifier: MIT
//
// How halos get from a device to messages, and from messages to a device: in the streams' own memory on native devices, through
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

}  // namespace sk::mpi
