// SPDX-License-Identifier: MIT
//
// Lists and opens EGL displays.
#include "gl/displays.hpp"

#include <dlfcn.h>
#include <string_view>

namespace sk::gl {

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
