// SPDX-License-Identifier: MIT
//
// A queue of GL objects whose owners have been destroyed. They are deleted when their context is current, so
// that owners may be destroyed anywhere, even while another context or none is current. If the context is
// never current again, its objects are deleted with it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sk::gl {

class BoundState;

class Deletions {
 public:
  using Delete = void (*)(BoundState& bound, std::uintptr_t object);

  /// Reserves room for one more object, before it is created, so that add() never allocates. Throws
  /// std::bad_alloc.
  void makeRoom() {
    const std::size_t needed = queued_.size() + living_ + 1;
    if (queued_.capacity() < needed) queued_.reserve(2 * needed);
  }
  /// Registers an object that has an owner from now on; there is room for it.
  void expect() noexcept { ++living_; }
  /// Queues an object whose owner is destroyed.
  void add(Delete how, std::uintptr_t object) noexcept {
    queued_.push_back({how, object});
    --living_;
  }

  /// Deletes the queued objects. Their context must be current.
  void run(BoundState& bound) noexcept {
    for (const Queued& one : queued_) one.how(bound, one.object);
    queued_.clear();
  }

 private:
  struct Queued {
    Delete how;
    std::uintptr_t object;
  };
  std::vector<Queued> queued_;
  std::size_t living_ = 0;
};

}  // namespace sk::gl
