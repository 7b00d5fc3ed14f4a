// SPDX-License-Identifier: MIT
//
// A GL or GL ES context: either our own, without a window, which is created on an EGL display, or the application's. A
// CurrentScope makes it current as long as the scope lives. open_context.hpp selects contexts.
#pragma once

#include <optional>
#include <string>

#include <epoxy/egl.h>

#include "gl/process_mark.hpp"

namespace sk::gl {

enum class Api { Gl, Es };

class Context {
 public:
  /// Takes ownership of a context, and of its pbuffer if it needs one (else EGL_NO_SURFACE).
  Context(EGLDisplay display, EGLContext context, EGLSurface surface);
  /// The context that is current on this thread through EGL or GLX, if there is one.
  static std::optional<Context> current();
  Context(Context&& other) noexcept;
  Context& operator=(Context&&) = delete;
  ~Context();

  bool isAdopted() const { return display_ == EGL_NO_DISPLAY; }
  bool isCurrent() const { return process_.isHere() && getCurrent_() == handle_; }
  /// Throws sk::Error in the child of a fork that came after this context.
  void checkProcess() const {
    if (!process_.isHere()) failInChild();
  }
  /// Makes the context current permanently. Throws like CurrentScope.
  void makeCurrent() const;
  /// Makes no context current if this one is.
  void release() const noexcept;

 private:
  friend class CurrentScope;
  Context() = default;
  [[noreturn]] static void failInChild();
  bool becomeCurrent() const noexcept {
    return eglMakeCurrent(display_, surface_, surface_, handle_) == EGL_TRUE;
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLSurface surface_ = EGL_NO_SURFACE;
  void* handle_ = nullptr;
  void* (*getCurrent_)() = nullptr;
  ProcessMark process_;
};

/// Makes a context current, and finally restores the previous one. If there was none, the context stays
/// current, so that the next scope costs nothing.
class CurrentScope {
 public:
  /// Throws sk::Error if the context cannot be made current on this thread, if it is an adopted context
  /// that is not current, or if it belongs to the process from which this one was forked.
  explicit CurrentScope(const Context& context) {
    context.checkProcess();
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

/// The name of an eglGetError() code: "EGL_BAD_ACCESS".
const char* eglErrorName(EGLint error);

/// Creates a context of the highest version that an initialised display supports: core GL from 3.3, or ES
/// from 3.0. If it fails, `why` gives the reason. Does not make the context current.
std::optional<Context> createContext(EGLDisplay display, Api api, std::string& why);

}  // namespace sk::gl
