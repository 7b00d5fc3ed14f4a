// SPDX-License-Identifier: MIT
//
// A place in the device's queue that one can wait for.
#pragma once

#include <utility>

#include <epoxy/gl.h>

namespace sk::gl {

class Fence {
 public:
  Fence() = default;
  /// After everything that was queued so far, which the device begins with now.
  static Fence insert();
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  ~Fence() {
    if (sync_ != nullptr) glDeleteSync(sync_);
  }

  /// Also where the driver cannot tell, as on a lost context: what comes next reports it.
  bool isReached() const;
  void wait() const;
  void forget() noexcept { sync_ = nullptr; }

 private:
  explicit Fence(GLsync sync) : sync_(sync) {}

  GLsync sync_ = nullptr;
};

}  // namespace sk::gl
