// SPDX-License-Identifier: MIT
//
// Finding a device: tries every EGL display until a context serves, and says why each other did not.
#pragma once

#include <optional>
#include <string>

#include "gl/capabilities.hpp"
#include "gl/context.hpp"

namespace sk::gl {

struct OpenRequest {
  std::string device;        ///< as DeviceOptions::device; empty: the best one with GL
  std::optional<Api> api;    ///< none: GL, or where that cannot be had ES
};

struct OpenedContext {
  Context context;
  Capabilities capabilities;
};

/// Throws sk::Error with every attempt, why it failed, and what can be done.
OpenedContext openContext(const OpenRequest& request);

/// The best context without a window, if it is that of a GPU.
std::optional<OpenedContext> findGpu();

/// The context that is current on this thread, if it serves; else throws sk::Error. An application's
/// state is put back.
OpenedContext adoptContext(std::optional<Api> api);

}  // namespace sk::gl
