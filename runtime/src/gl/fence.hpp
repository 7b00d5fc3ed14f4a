// SPDX-License-Identifier: MIT
//
// A point in the device's command queue that the host can wait for.
#pragma once

#include <utility>

#include <epoxy/gl.h>

#include "gl/deletions.hpp"

namespace sk::gl {

class Fence {
 public:
  Fence() = default;
  /// Inserts a fence after all commands queued so far, and flushes them. Empty if the driver returns none.
  static Fence insert(Deletions& deletions);
  Fence(Fence&& other) noexcept : deletions_(other.deletions_), sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(deletions_, other.deletions_);
    std::swap(sync_, other.sync_);
    return *this;
  }
  ~Fence();
  explicit operator bool() const { return sync_ != nullptr; }

  /// True also if the driver fails, as on a lost context: the next operation reports the failure.
  bool isReached() const;
  void wait() const;

 private:
  Deletions* deletions_ = nullptr;
  GLsync sync_ = nullptr;
};

}  // namespace sk::gl
