// SPDX-License-Identifier: MIT
//
// Points in the device's command queue, after all earlier commands: fences, for which the host can wait, and timestamps,
// which record when the device got there, and which the host reads later.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include <epoxy/gl.h>

#include "gl/capabilities.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

/// The host can wait for it.
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

inline void deleteQuery(BoundState&, GLuint name) { glDeleteQueries(1, &name); }

/// Whether the current context supports timestamps: OpenGL does, unless its clock has no bits.
bool hasTimestamps(const Capabilities& capabilities);

/// The device's current time in nanoseconds, from an arbitrary origin. May wait for the driver, but not for
/// queued work.
std::int64_t timestampNow();

class Timestamp {
 public:
  Timestamp() = default;
  explicit Timestamp(Deletions& deletions) : name_(deletions, [] { return generated(glGenQueries); }) {}

  explicit operator bool() const { return static_cast<bool>(name_); }
  /// Queues the query.
  void take() const { glQueryCounter(name_.get(), GL_TIMESTAMP); }
  /// The recorded time in nanoseconds; nullopt if the device has not reached it yet.
  std::optional<std::int64_t> result() const;

 private:
  ObjectName<deleteQuery> name_;
};

}  // namespace sk::gl
