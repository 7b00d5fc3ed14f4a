// SPDX-License-Identifier: MIT
//
// Timestamps of the device: a query records the time when all earlier commands are done; the host reads it
// later.
#pragma once

#include <cstdint>
#include <optional>

#include "gl/capabilities.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

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
