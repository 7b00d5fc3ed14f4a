// SPDX-License-Identifier: MIT
//
// GL objects whose owners have ended. They wait here until their context is current, so that an owner may end anywhere, also while another
// context is current, or while none is. Where the context never is again, its objects die with it.
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

  /// Makes room for one more object, which is about to be made, so that add() never allocates. Throws std::bad_alloc.
  void makeRoom() {
    const std::size_t needed = queued_.size() + living_ + 1;
    if (queued_.capacity() < needed) queued_.reserve(2 * needed);
  }
  /// An object has an owner from now on; there is room for it.
  void expect() noexcept { ++living_; }
  /// Its owner ends.
  void add(Delete how, std::uintptr_t object) noexcept {
    queued_.push_back({how, object});
    --living_;
  }

  /// Deletes them. Their context is current.
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
