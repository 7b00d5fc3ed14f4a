// SPDX-License-Identifier: MIT
//
// A context for hand-written GL, on the same renderer as a device of the runtime's, which it must not use.
#pragma once

#include <string>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace bench {

/// A context without a window on the renderer of this name. It is current only where `Current` says so.
class PlainContext {
 public:
  /// Throws std::runtime_error where no display has such a renderer with GL 3.3.
  explicit PlainContext(const std::string& renderer);
  ~PlainContext();
  PlainContext(const PlainContext&) = delete;
  PlainContext& operator=(const PlainContext&) = delete;

  /// Makes the context current for as long as it lives, and none after that.
  class Current {
   public:
    explicit Current(const PlainContext& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

   private:
    EGLDisplay display_;
  };

 private:
  bool tryDisplay(EGLDisplay display, const std::string& renderer);

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

/// A program of this fragment shader, and of a vertex shader that covers the target with one triangle. Throws
/// std::runtime_error with the driver's words.
GLuint linkedProgram(const char* fragmentText);

}  // namespace bench
