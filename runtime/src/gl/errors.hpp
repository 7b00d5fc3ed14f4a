// SPDX-License-Identifier: MIT
//
// A context's GL error flags. They are read only after operations that can run out of memory and when results
// arrive, never during a call.
#pragma once

#include <utility>

#include <epoxy/gl.h>

namespace sk::gl {

class Errors {
 public:
  /// Saves the pending error for take(), so that takeNew() returns only later errors.
  void setAside() {
    const GLenum error = takeNew();
    if (earlier_ == GL_NO_ERROR) earlier_ = error;
  }
  /// Returns the first error since setAside(), and clears all of them.
  GLenum takeNew();
  /// Returns the first error that has not been taken yet.
  GLenum take() {
    setAside();
    return std::exchange(earlier_, GL_NO_ERROR);
  }

  /// Whether the context is known to be lost; it then stays lost.
  bool isLost() const { return isLost_; }
  /// Queries the driver. The context must be current and have a reset status (Capabilities::reportsResets).
  bool askIfLost() {
    isLost_ = isLost_ || glGetGraphicsResetStatus() != GL_NO_ERROR;
    return isLost_;
  }

 private:
  GLenum earlier_ = GL_NO_ERROR;
  bool isLost_ = false;
};

/// The name of an error: "GL_OUT_OF_MEMORY".
const char* errorName(GLenum error);

}  // namespace sk::gl
