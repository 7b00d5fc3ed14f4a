// SPDX-License-Identifier: MIT
//
// A place in the device's queue that one can wait for.
#pragma once

#include <utility>

#include <epoxy/gl.h>

#include "gl/deletions.hpp"

namespace sk::gl {

class Fence {
 public:
  Fence() = default;
  /// After everything that was queued so far, which the device begins with now. Empty where the driver gives none.
  static Fence insert(Deletions& deletions);
  Fence(Fence&& other) noexcept : deletions_(other.deletions_), sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(deletions_, other.deletions_);
    std::swap(sync_, other.sync_);
    return *this;
  }
  ~Fence();
  explicit operator bool() const { return sync_ != nullptr; }

  /// Also where the driver cannot tell, as on a lost context: what comes next reports it.
  bool isReached() const;
  void wait() const;

 private:
  Deletions* deletions_ = nullptr;
  GLsync sync_ = nullptr;
};

}  // namespace sk::gl
