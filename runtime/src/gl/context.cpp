// SPDX-License-Identifier: MIT
//
// Creates a context on a display, for which it selects the API, the configuration and the version; its lifetime, and which
// one is current.

#include "gl/context.hpp"

#include <dlfcn.h>
#include <cstdio>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "gl/open_context.hpp"
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
      getCurrent_(other.getCurrent_),
      process_(other.process_) {}

// The display stays initialised: all of the process shares it, and EGL does not count users, so that
// terminating it would destroy other devices' contexts and the application's own.
Context::~Context() {
  if (handle_ != nullptr && !isAdopted() && process_.isHere()) {
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

void Context::failInChild() {
  throw Error(
      "the device belongs to the process that forked this one, and drivers of OpenGL do not work in the "
      "child; use a native "
      "device here (SK_DEVICE=native), fork before the first device is created, or let the child exec() a "
      "program",
      Error::Kind::Lost);
}

void Context::makeCurrent() const {
  checkProcess();
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

namespace {

using Version = std::pair<EGLint, EGLint>;
constexpr Version glVersions[] = {{4, 6}, {4, 5}, {4, 4}, {4, 3}, {4, 2}, {4, 1}, {4, 0}, {3, 3}};
constexpr Version esVersions[] = {{3, 2}, {3, 1}, {3, 0}};

/// Binds an API for creating contexts, and finally restores the application's.
class ApiScope {
 public:
  explicit ApiScope(Api api) : previous_(eglQueryAPI()) {
    isBound_ = eglBindAPI(api == Api::Gl ? EGL_OPENGL_API : EGL_OPENGL_ES_API) == EGL_TRUE;
  }
  ~ApiScope() {
    if (previous_ != EGL_NONE) {
      eglBindAPI(previous_);
    }
  }
  ApiScope(const ApiScope&) = delete;
  ApiScope& operator=(const ApiScope&) = delete;
  bool isBound() const { return isBound_; }

 private:
  EGLenum previous_;
  bool isBound_;
};

/// Whether contexts of both APIs report resets, without an extension.
bool isEgl15(EGLDisplay display) {
  const char* version = eglQueryString(display, EGL_VERSION);
  int major = 0, minor = 0;
  return version != nullptr && std::sscanf(version, "%d.%d", &major, &minor) == 2 &&
         std::pair(major, minor) >= std::pair(1, 5);
}

EGLConfig chooseConfig(EGLDisplay display, Api api) {
  for (const EGLint surfaces : {EGL_PBUFFER_BIT, 0}) {
    const EGLint attributes[] = {EGL_SURFACE_TYPE, surfaces, EGL_RENDERABLE_TYPE,
                                 api == Api::Gl ? EGL_OPENGL_BIT : EGL_OPENGL_ES3_BIT, EGL_NONE};
    EGLConfig config = EGL_NO_CONFIG_KHR;
    EGLint count = 0;
    if (eglChooseConfig(display, attributes, &config, 1, &count) == EGL_TRUE && count > 0) {
      return config;
    }
  }
  return EGL_NO_CONFIG_KHR;
}

/// `reportsResets`: creates a context that a GPU reset makes lost, which the driver reports.
EGLContext createHighest(EGLDisplay display, EGLConfig config, Api api, bool reportsResets) {
  const std::span<const Version> versions =
      api == Api::Gl ? std::span<const Version>(glVersions) : std::span<const Version>(esVersions);
  for (const auto& [major, minor] : versions) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION, minor};
    if (api == Api::Gl) {
      attributes.insert(attributes.end(),
                        {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
    }
    if (reportsResets) {
      attributes.insert(attributes.end(),
                        {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
    }
    attributes.push_back(EGL_NONE);
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (context != EGL_NO_CONTEXT) {
      return context;
    }
  }
  return EGL_NO_CONTEXT;
}

}  // namespace

std::optional<Context> createContext(EGLDisplay display, Api api, std::string& why) {
  const ApiScope apiScope(api);
  if (!apiScope.isBound()) {
    why = fmt::format("EGL does not offer it ({})", eglErrorName(eglGetError()));
    return std::nullopt;
  }
  const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
  const EGLConfig config = chooseConfig(display, api);
  if (config == EGL_NO_CONFIG_KHR && !hasExtension(extensions, "EGL_KHR_no_config_context")) {
    why = "it has no configuration without a window";
    return std::nullopt;
  }
  EGLContext context =
      isEgl15(display) ? createHighest(display, config, api, /*reportsResets=*/true) : EGL_NO_CONTEXT;
  if (context == EGL_NO_CONTEXT) context = createHighest(display, config, api, /*reportsResets=*/false);
  if (context == EGL_NO_CONTEXT) {
    why = fmt::format("it gives no context of version {} or later ({})", api == Api::Gl ? "3.3 core" : "3.0",
                      eglErrorName(eglGetError()));
    return std::nullopt;
  }
  EGLSurface surface = EGL_NO_SURFACE;
  if (!hasExtension(extensions, "EGL_KHR_surfaceless_context")) {
    const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    surface = eglCreatePbufferSurface(display, config, size);
  }
  return Context(display, context, surface);
}

}  // namespace sk::gl
