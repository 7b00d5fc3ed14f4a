// SPDX-License-Identifier: MIT
//
// Lifetime of a context, and which one is current.
#include "gl/context.hpp"

#include <dlfcn.h>
#include <string>
#include <utility>

#include "sk/error.hpp"

namespace sk::gl {

namespace {

using GetCurrent = void* (*)();

/// A function of a library that the process has already loaded, else null.
GetCurrent loadedFunction(const char* library, const char* function) {
  void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
  if (handle == nullptr) {
    return nullptr;
  }
  void* address = dlsym(handle, function);
  dlclose(handle);
  return reinterpret_cast<GetCurrent>(address);
}

std::string whyNotCurrent(EGLint error, bool isGlxCurrent) {
  if (isGlxCurrent) {
    return "a GLX context is current on this thread, beside which EGL makes none current; adopt it "
           "(sk::Device::adopt), or let go of it first";
  }
  if (error == EGL_BAD_ACCESS) {
    return "the device is in use by another thread; call Device::release() there first";
  }
  return std::string("the device's context cannot be made current: ") + eglErrorName(error);
}

}  // namespace

Context::Context(EGLDisplay display, EGLContext context, EGLSurface surface)
    : display_(display),
      surface_(surface),
      handle_(context),
      getCurrent_(loadedFunction("libEGL.so.1", "eglGetCurrentContext")) {}

std::optional<Context> Context::current() {
  constexpr std::pair<const char*, const char*> systems[] = {{"libEGL.so.1", "eglGetCurrentContext"},
                                                             {"libGLX.so.0", "glXGetCurrentContext"},
                                                             {"libGL.so.1", "glXGetCurrentContext"}};
  for (const auto& [library, function] : systems) {
    const GetCurrent getCurrent = loadedFunction(library, function);
    if (getCurrent != nullptr && getCurrent() != nullptr) {
      Context context;
      context.handle_ = getCurrent();
      context.getCurrent_ = getCurrent;
      return context;
    }
  }
  return std::nullopt;
}

Context::Context(Context&& other) noexcept
    : display_(other.display_),
      surface_(other.surface_),
      handle_(std::exchange(other.handle_, nullptr)),
      getCurrent_(other.getCurrent_) {}

// The display stays initialised: all of the process shares it, and EGL does not count users, so that
// terminating it would destroy other devices' contexts and the application's own.
Context::~Context() {
  if (handle_ != nullptr && !isAdopted()) {
    release();
    eglDestroyContext(display_, handle_);
    if (surface_ != EGL_NO_SURFACE) {
      eglDestroySurface(display_, surface_);
    }
  }
}

void Context::release() const noexcept {
  if (!isAdopted() && isCurrent()) {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
}

void Context::makeCurrent() const {
  if (isAdopted()) {
    throw Error(
        "the context that the device adopted is not current on this thread; make it current before "
        "you use the device or its streams");
  }
  const bool hadNone = eglGetCurrentContext() == EGL_NO_CONTEXT;
  if (!becomeCurrent()) {
    const EGLint error = eglGetError();
    throw Error(whyNotCurrent(error, hadNone && current().has_value()), Error::Kind::Lost);
  }
}

void CurrentScope::enter(const Context& context) {
  previous_ = eglGetCurrentContext();
  if (previous_ != EGL_NO_CONTEXT) {
    display_ = eglGetCurrentDisplay();
    draw_ = eglGetCurrentSurface(EGL_DRAW);
    read_ = eglGetCurrentSurface(EGL_READ);
  }
  context.makeCurrent();
}

const char* eglErrorName(EGLint error) {
  switch (error) {
    case EGL_SUCCESS: return "no reason given";
    case EGL_NOT_INITIALIZED: return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ACCESS: return "EGL_BAD_ACCESS";
    case EGL_BAD_ALLOC: return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE: return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONTEXT: return "EGL_BAD_CONTEXT";
    case EGL_BAD_CONFIG: return "EGL_BAD_CONFIG";
    case EGL_BAD_CURRENT_SURFACE: return "EGL_BAD_CURRENT_SURFACE";
    case EGL_BAD_DISPLAY: return "EGL_BAD_DISPLAY";
    case EGL_BAD_SURFACE: return "EGL_BAD_SURFACE";
    case EGL_BAD_MATCH: return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER: return "EGL_BAD_PARAMETER";
    case EGL_CONTEXT_LOST: return "EGL_CONTEXT_LOST";
    default: return "an unknown EGL error";
  }
}

}  // namespace sk::gl
