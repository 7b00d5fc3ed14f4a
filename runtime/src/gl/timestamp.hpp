// SPDX-License-Identifier: MIT
//
// Moments of the device: a query that takes the time when everything before it is done, asked for later.
#pragma once

#include <cstdint>
#include <optional>

#include "gl/capabilities.hpp"
#include "gl/object_name.hpp"

namespace sk::gl {

inline void deleteQuery(BoundState&, GLuint name) { glDeleteQueries(1, &name); }

/// Whether the current context takes timestamps: OpenGL does, unless its clock has no bits.
bool hasTimestamps(const Capabilities& capabilities);

/// The device's clock now, in nanoseconds since some moment. It may wait for the driver, not for the device's work.
std::int64_t timestampNow();

class Timestamp {
 public:
  Timestamp() = default;
  explicit Timestamp(Deletions& deletions) : name_(deletions, [] { return generated(glGenQueries); }) {}

  explicit operator bool() const { return static_cast<bool>(name_); }
  /// Queues the taking of the time.
  void take() const { glQueryCounter(name_.get(), GL_TIMESTAMP); }
  /// Nanoseconds of the device's clock; none where the device has not come so far.
  std::optional<std::int64_t> result() const;

 private:
  ObjectName<deleteQuery> name_;
};

}  // namespace sk::gl
