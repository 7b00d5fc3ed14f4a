// SPDX-License-Identifier: MIT
//
// The EGL displays through which a context without a window may be had, in the order in which they
// are worth a try: the surfaceless platform, each EGL device, the default display.
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
  bool isSoftware = false;       ///< Kind::Device: known to be a program on the CPU
};

/// libEGL must be loadable (whyNoEglLibrary).
std::vector<DisplayCandidate> displayCandidates();

/// EGL_NO_DISPLAY where there is none.
EGLDisplay openDisplay(const DisplayCandidate& candidate);

/// libepoxy ends the process where it cannot load a library, so that these must be asked before EGL,
/// and before a context of an API, is touched: the loader's message, or empty where all is well.
std::string whyNoEglLibrary();
std::string whyNoLibrary(Api api);

/// Whether a space-separated list of extensions (null: none) has `extension`.
bool hasExtension(const char* list, const char* extension);

}  // namespace sk::gl
