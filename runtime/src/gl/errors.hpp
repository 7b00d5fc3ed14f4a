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
    if (earlier_ == GL_NO_ERROR || error == GL_OUT_OF_MEMORY) earlier_ = error;
  }
  /// Must be called when a call begins in the application's context: the pending errors are the application's, and neither take()
  /// nor takeNew() returns them. GL has no way to put them back.
  void skipApplications() { static_cast<void>(takeNew()); }
  /// Returns the first error since setAside(), or that memory is exhausted if it is among them, and clears all of them.
  GLenum takeNew();
  /// Likewise, of all errors that have not been taken yet.
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
