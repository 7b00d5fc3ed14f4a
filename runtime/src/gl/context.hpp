// SPDX-License-Identifier: MIT
//
// A GL or GL ES context: one of our own that needs no window, or the application's. A CurrentScope
// makes it current for as long as it lives. Which context to take is open_context.hpp's business.
#pragma once

#include <optional>

#include <epoxy/egl.h>

namespace sk::gl {

enum class Api { Gl, Es };

class Context {
 public:
  /// Takes over a context of our own, and its pbuffer where it needs one (else EGL_NO_SURFACE).
  Context(EGLDisplay display, EGLContext context, EGLSurface surface);
  /// The context that is current on this thread, by EGL or GLX; none where there is none.
  static std::optional<Context> current();
  Context(Context&& other) noexcept;
  Context& operator=(Context&&) = delete;
  ~Context();

  bool isAdopted() const { return display_ == EGL_NO_DISPLAY; }
  bool isCurrent() const { return getCurrent_() == handle_; }
  /// Makes it current, for longer than a CurrentScope does. Throws as that.
  void makeCurrent() const;
  /// Makes no context current where this one is.
  void release() const noexcept;

 private:
  friend class CurrentScope;
  Context() = default;
  bool becomeCurrent() const noexcept {
    return eglMakeCurrent(display_, surface_, surface_, handle_) == EGL_TRUE;
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
  void* handle_ = nullptr;
  void* (*getCurrent_)() = nullptr;
};

/// Makes a context current. At its end the one that was current before is so again; where there was
/// none, the context stays, so that the next scope costs nothing.
class CurrentScope {
 public:
  /// Throws sk::Error where the context cannot be made current on this thread, or is an adopted one
  /// that is not current.
  explicit CurrentScope(const Context& context) {
    if (!context.isCurrent()) {
      enter(context);
    }
  }
  ~CurrentScope() {
    if (previous_ != EGL_NO_CONTEXT) {
      eglMakeCurrent(display_, draw_, read_, previous_);
    }
  }
  CurrentScope(const CurrentScope&) = delete;
  CurrentScope& operator=(const CurrentScope&) = delete;

 private:
  void enter(const Context& context);

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface draw_ = EGL_NO_SURFACE;
  EGLSurface read_ = EGL_NO_SURFACE;
  EGLContext previous_ = EGL_NO_CONTEXT;
};

/// "EGL_BAD_ACCESS", of eglGetError().
const char* eglErrorName(EGLint error);

}  // namespace sk::gl
