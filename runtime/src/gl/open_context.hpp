// SPDX-License-Identifier: MIT
//
// Finds a device: tries every EGL display until a context is usable, and reports why the others are not.
#pragma once

#include <optional>
#include <string>

#include "gl/capabilities.hpp"
#include "gl/context.hpp"

namespace sk::gl {

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
OpenedContext adoptContext(std::optional<Api> api);

}  // namespace sk::gl
