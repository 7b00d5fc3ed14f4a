// SPDX-License-Identifier: MIT
//
// Parses the name of a device, and searches for a usable context. Collects every failure for the report and prints nothing.
// Lists and opens EGL displays.
#include "gl/open_context.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include <dlfcn.h>

#include <fmt/format.h>

#include "gl/bound_state.hpp"
#include "gl/context.hpp"
#include "gl/saved_state.hpp"
#include "sk/error.hpp"

namespace sk::gl {

namespace {

int parseNumber(const std::string& text) {
  constexpr std::size_t prefix = 4;  // "gpu:"
  int number = -1;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + prefix, end, number);
  if (error != std::errc{} || rest != end || number < 0) {
    throw Error(fmt::format("'{}' names no device; after 'gpu:' comes a number, from 0", text),
                Error::Kind::Device);
  }
  return number;
}

}  // namespace

WantedDevice WantedDevice::parse(const std::string& text) {
  const std::string name = lowerCase(text);
  if (name.empty() || name == "gl") {
    return {};
  }
  if (name == "gpu") {
    return {Kind::Gpu, 0, {}};
  }
  if (name == "software") {
    return {Kind::Software, 0, {}};
  }
  if (name.starts_with("gpu:")) {
    return {Kind::NumberedGpu, parseNumber(name), {}};
  }
  return {Kind::Renderer, 0, name};
}

std::string WantedDevice::whyNot(const Capabilities& capabilities) const {
  switch (kind) {
    case Kind::Best: return "";
    case Kind::Gpu:
    case Kind::NumberedGpu:
      return capabilities.isSoftware ? fmt::format("'{}' is not a GPU", capabilities.renderer) : "";
    case Kind::Software:
      return capabilities.isSoftware ? "" : fmt::format("'{}' is a GPU", capabilities.renderer);
    case Kind::Renderer:
      return lowerCase(capabilities.renderer).find(renderer) != std::string::npos
                 ? ""
                 : fmt::format("its renderer is '{}'", capabilities.renderer);
  }
  return "";
}

namespace {

/// A search, with all attempts and their results.
class Search {
 public:
  explicit Search(const OpenRequest& request)
      : request_(request), wanted_(WantedDevice::parse(request.device)) {}

  /// Returns the requested context, if there is one.
  std::optional<OpenedContext> find() {
    if (const std::string why = whyNoEglLibrary(); !why.empty()) {
      failed("EGL", why);
      return std::nullopt;
    }
    const std::vector<DisplayCandidate> candidates = displayCandidates();
    const auto gpus = std::ranges::count_if(candidates, [](const DisplayCandidate& candidate) {
      return candidate.kind == DisplayCandidate::Kind::Device && !candidate.isSoftware;
    });
    const RendererKind enough = gpus > 1 ? RendererKind::Discrete : RendererKind::Virtual;
    for (const DisplayCandidate& candidate : candidates) {
      std::optional<OpenedContext> opened = isWorthTrying(candidate) ? tryCandidate(candidate) : std::nullopt;
      if (!opened) {
        continue;
      }
      if (!wanted_.mayChoose() || opened->capabilities.kind >= enough) {
        return opened;
      }
      if (!best_ || best_->capabilities.kind < opened->capabilities.kind) {
        best_.reset();
        best_.emplace(std::move(*opened));
      }
    }
    return std::move(best_);
  }

  /// Throws sk::Error, which lists all attempts.
  [[noreturn]] void report() const {
    const std::string what = wanted_.kind == WantedDevice::Kind::Best
                                 ? "no device was found"
                                 : fmt::format("no device '{}' was found", request_.device);
    throw Error(
        fmt::format(
            "{}; tried without a window:{}\n"
            "  what can be done: install a driver (for software rendering on Debian: apt-get install libegl1 "
            "libgl1 libgles2 libgl1-mesa-dri); let the user read and write /dev/dri/renderD*; choose another "
            "device by SK_DEVICE (gpu, gpu:N, software, native, or a part of a renderer's name); see what "
            "EGL "
            "itself says by EGL_LOG_LEVEL=debug; or adopt the context of a window (sk::Device::adopt)",
            what, attempts_),
        Error::Kind::Device);
  }

 private:
  /// A software renderer is used only if no GPU is found, and an integrated or virtual GPU only if there is no discrete one.
  /// The default display is not searched for GPUs, because it may be somebody's screen.
  bool isWorthTrying(const DisplayCandidate& candidate) {
    using Kind = DisplayCandidate::Kind;
    if (best_ && (candidate.isSoftware || candidate.kind == Kind::Default)) {
      return false;
    }
    if (candidate.isSoftware && !wanted_.mayBeSoftware()) {
      return failed(candidate.name, "it is not a GPU");
    }
    if (wanted_.kind == WantedDevice::Kind::NumberedGpu) {
      if (candidate.kind != Kind::Device) {
        return false;
      }
      const int number = gpus_++;
      return number == wanted_.number || failed(candidate.name, fmt::format("it is gpu:{}", number));
    }
    return true;
  }

  std::optional<OpenedContext> tryCandidate(const DisplayCandidate& candidate) {
    EGLDisplay display = openDisplay(candidate);
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
      failed(candidate.name, fmt::format("it cannot be opened ({})", eglErrorName(eglGetError())));
      return std::nullopt;
    }
    for (const Api api : {Api::Gl, Api::Es}) {
      if (request_.api.value_or(api) != api) {
        continue;
      }
      if (std::optional<OpenedContext> opened = tryApi(candidate.name, display, api)) {
        const std::string why = wanted_.whyNot(opened->capabilities);
        if (why.empty()) {
          return opened;
        }
        failed(candidate.name, why);
        return std::nullopt;
      }
    }
    return std::nullopt;
  }

  /// Returns a usable context, whether or not it is the requested one.
  std::optional<OpenedContext> tryApi(const std::string& name, EGLDisplay display, Api api) {
    std::string why = whyNoLibrary(api);
    if (std::optional<Context> context = why.empty() ? createContext(display, api, why) : std::nullopt) {
      OpenedContext opened{std::move(*context), {}};
      why = examine(opened);
      if (why.empty()) {
        return opened;
      }
    }
    failed(fmt::format("{} ({})", name, api == Api::Gl ? "OpenGL" : "OpenGL ES"), why);
    return std::nullopt;
  }

  /// Reads the context's capabilities. Returns why they are not sufficient, or an empty string.
  static std::string examine(OpenedContext& opened) {
    try {
      const CurrentScope scope(opened.context);
      opened.capabilities = readCapabilities();
      BoundState bound;
      return whyUnfit(opened.capabilities, bound);
    } catch (const Error& error) {
      return error.what();
    }
  }

  bool failed(const std::string& attempt, const std::string& why) {
    attempts_ += fmt::format("\n  {}: {}", attempt, why);
    return false;
  }

  const OpenRequest& request_;
  WantedDevice wanted_;
  std::string attempts_;
  std::optional<OpenedContext> best_;  ///< the best one so far
  int gpus_ = 0;
};

std::string whyUnfitSaved(const Capabilities& capabilities) {
  BoundState bound;
  if (capabilities.version < 30) {
    return whyUnfit(capabilities, bound);
  }
  const SavedState saved(capabilities, bound);
  return whyUnfit(capabilities, bound);
}

/// Whether this process is the child of one that has used EGL before the fork. Drivers have threads and locks that the child
/// lacks, so that even a new context would hang.
bool isForked() {
  static const ProcessMark firstUse;
  return !firstUse.isHere();
}

[[noreturn]] void failAsForked() {
  throw Error(
      "no device with OpenGL can be opened in this process: the process that forked it had used OpenGL "
      "before, whose drivers "
      "do not work in the child; use a native device here (SK_DEVICE=native), fork before the first device "
      "is created, or "
      "let the child exec() a program",
      Error::Kind::Device);
}

}  // namespace

OpenedContext openContext(const OpenRequest& request) {
  if (isForked()) failAsForked();
  Search search(request);
  std::optional<OpenedContext> found = search.find();
  if (!found) search.report();
  return std::move(*found);
}

std::optional<OpenedContext> findGpu() {
  if (isForked()) return std::nullopt;
  const OpenRequest best;
  std::optional<OpenedContext> found = Search(best).find();
  if (found && found->capabilities.isSoftware) found.reset();
  return found;
}

OpenedContext adoptContext(std::optional<Api> api, std::string_view profile) {
  if (isForked()) failAsForked();
  std::optional<Context> context = Context::current();
  if (!context) {
    throw Error("there is no context to adopt; make one current on this thread by EGL or GLX first",
                Error::Kind::Device);
  }
  OpenedContext opened{std::move(*context), readCapabilities()};
  const Api found = opened.capabilities.api;
  if (api.value_or(found) != found) {
    throw Error(fmt::format("the context to adopt is one of {}, which profile {} does not run on",
                            found == Api::Gl ? "OpenGL" : "OpenGL ES", profile),
                Error::Kind::Device);
  }
  if (const std::string why = whyUnfitSaved(opened.capabilities); !why.empty()) {
    throw Error("the current context cannot be adopted: " + why, Error::Kind::Device);
  }
  return opened;
}

namespace {

template <class Function>
Function eglFunction(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// Empty if one of `names` can be loaded, else the loader's message.
std::string whyUnloadable(std::initializer_list<const char*> names) {
  std::string why;
  for (const char* name : names) {
    if (void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL)) {
      dlclose(library);
      return "";
    }
    const char* message = dlerror();
    why += why.empty() ? "" : "; ";
    why += message == nullptr ? name : message;
  }
  return why;
}

std::vector<EGLDeviceEXT> eglDevices() {
  const auto queryDevices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  EGLint count = 0;
  if (queryDevices == nullptr || queryDevices(0, nullptr, &count) != EGL_TRUE || count <= 0) {
    return {};
  }
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  if (queryDevices(count, devices.data(), &count) != EGL_TRUE) {
    return {};
  }
  devices.resize(static_cast<std::size_t>(count));
  return devices;
}

bool isSoftwareDevice(EGLDeviceEXT device) {
  const auto queryString = eglFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  return queryString != nullptr &&
         hasExtension(queryString(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

}  // namespace

std::string whyNoEglLibrary() { return whyUnloadable({"libEGL.so.1"}); }

std::string whyNoLibrary(Api api) {
  return api == Api::Gl ? whyUnloadable({"libOpenGL.so.0", "libGL.so.1"}) : whyUnloadable({"libGLESv2.so.2"});
}

bool hasExtension(const char* list, const char* extension) {
  std::string_view rest = list == nullptr ? "" : list;
  while (!rest.empty()) {
    const std::size_t end = rest.find(' ');
    if (rest.substr(0, end) == extension) {
      return true;
    }
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return false;
}

std::vector<DisplayCandidate> displayCandidates() {
  using Kind = DisplayCandidate::Kind;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  std::vector<DisplayCandidate> candidates;
  if (hasExtension(client, "EGL_EXT_platform_base")) {
    if (hasExtension(client, "EGL_MESA_platform_surfaceless")) {
      candidates.push_back({Kind::Surfaceless, "surfaceless platform"});
    }
    if (hasExtension(client, "EGL_EXT_platform_device")) {
      int number = 0;
      for (const EGLDeviceEXT device : eglDevices()) {
        candidates.push_back(
            {Kind::Device, "EGL device " + std::to_string(number++), device, isSoftwareDevice(device)});
      }
    }
  }
  candidates.push_back({Kind::Default, "default display"});
  return candidates;
}

EGLDisplay openDisplay(const DisplayCandidate& candidate) {
  using Kind = DisplayCandidate::Kind;
  if (candidate.kind == Kind::Default) {
    return eglGetDisplay(EGL_DEFAULT_DISPLAY);
  }
  const auto getDisplay = eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (getDisplay == nullptr) {
    return EGL_NO_DISPLAY;
  }
  return candidate.kind == Kind::Surfaceless
             ? getDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
             : getDisplay(EGL_PLATFORM_DEVICE_EXT, candidate.device, nullptr);
}

}  // namespace sk::gl
