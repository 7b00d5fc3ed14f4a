// SPDX-License-Identifier: MIT
//
// The EGL displays that may support contexts without windows, in order of preference: the surfaceless
// platform, each EGL device, the default display.
#pragma once

#include <string>
#include <vector>

#include <epoxy/egl.h>

#include "gl/context.hpp"

namespace sk::gl {

struct DisplayCandidate {
  enum class Kind { Surfaceless, Device, Default };
  Kind kind;
  std::string name;              ///< "EGL device 0", for reports
  EGLDeviceEXT device = nullptr; ///< Kind::Device
  bool isSoftware = false;  ///< Kind::Device: known to render on the CPU
};

/// Requires that libEGL can be loaded (whyNoEglLibrary).
std::vector<DisplayCandidate> displayCandidates();

/// EGL_NO_DISPLAY if the display cannot be opened.
EGLDisplay openDisplay(const DisplayCandidate& candidate);

/// The loader's message if a library cannot be loaded, else empty. These must be called before EGL, or a
/// context of an API, is used: libepoxy ends the process if it cannot load a library.
std::string whyNoEglLibrary();
std::string whyNoLibrary(Api api);

/// Whether a space-separated list of extensions (null if empty) contains `extension`.
bool hasExtension(const char* list, const char* extension);

}  // namespace sk::gl
