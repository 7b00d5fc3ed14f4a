// SPDX-License-Identifier: MIT
//
// Finds a device: parses which one the user wants, tries every EGL display until a context is usable and is the wanted
// device, and reports why the others are not.
//
// The EGL displays that may support contexts without windows, in order of preference: the surfaceless
// platform, each EGL device, the default display.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <epoxy/egl.h>

#include "gl/capabilities.hpp"
#include "gl/context.hpp"

namespace sk::gl {

struct DisplayCandidate {
  enum class Kind { Surfaceless, Device, Default };
  Kind kind;
  std::string name;  ///< "EGL device 0", for reports
  EGLDeviceEXT device = nullptr;  ///< Kind::Device
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

struct WantedDevice {
  enum class Kind { Best, Gpu, NumberedGpu, Software, Renderer };
  Kind kind = Kind::Best;
  int number = 0;  ///< NumberedGpu
  std::string renderer;  ///< Renderer: a part of its name, in lower case

  /// Parses "" or "gl" (the best), "gpu", "gpu:N", "software", or a part of a renderer's name. Throws
  /// sk::Error if N is not a number.
  static WantedDevice parse(const std::string& text);

  /// Whether any device of some kind will do, so that the best one is chosen.
  bool mayChoose() const { return kind == Kind::Best || kind == Kind::Gpu; }
  bool mayBeSoftware() const { return kind != Kind::Gpu && kind != Kind::NumberedGpu; }
  /// Why a usable context is not the requested one; empty if it is.
  std::string whyNot(const Capabilities& capabilities) const;
};

struct OpenRequest {
  std::string device;  ///< as DeviceOptions::device; empty: the best one with GL
  std::optional<Api> api;  ///< nullopt: GL if it is available, else ES
};

struct OpenedContext {
  Context context;
  Capabilities capabilities;
};

/// The requested context. Of several, a discrete GPU comes before an integrated one, this before a virtual one, and this before a
/// software renderer (known_devices.def). Throws sk::Error, which lists every attempt, its failure, and possible remedies.
OpenedContext openContext(const OpenRequest& request);

/// The best context without a window, if it belongs to a GPU.
std::optional<OpenedContext> findGpu();

/// The context that is current on this thread; throws sk::Error if it is not sufficient. Restores the
/// application's state.
OpenedContext adoptContext(std::optional<Api> api, std::string_view profile);

}  // namespace sk::gl
