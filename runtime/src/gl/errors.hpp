// SPDX-License-Identifier: MIT
//
// GL's error flags of a context. They are read where something can fail for want of memory and where results
// arrive, never on the path of a call.
#pragma once

#include <utility>

#include <epoxy/gl.h>

namespace sk::gl {

class Errors {
 public:
  /// Keeps the pending error for take(), so that takeNew() tells what comes after.
  void setAside() {
    const GLenum error = takeNew();
    if (earlier_ == GL_NO_ERROR) earlier_ = error;
  }
  /// The first error since setAside(); clears all of these.
  GLenum takeNew();
  /// The first error that nobody has taken yet.
  GLenum take() {
    setAside();
    return std::exchange(earlier_, GL_NO_ERROR);
  }

  /// Whether the context was found to be lost, as it then stays.
  bool isLost() const { return isLost_; }
  /// Asks the driver. The context is current and has a reset status (Capabilities::tellsResets).
  bool askIfLost() {
    isLost_ = isLost_ || glGetGraphicsResetStatus() != GL_NO_ERROR;
    return isLost_;
  }
  void setLost() { isLost_ = true; }

 private:
  GLenum earlier_ = GL_NO_ERROR;
  bool isLost_ = false;
};

/// The name of an error: "GL_OUT_OF_MEMORY".
const char* errorName(GLenum error);

}  // namespace sk::gl
