// SPDX-License-Identifier: MIT
//
// What a user may say of the device that they want, and whether a context is it.
#pragma once

#include <string>

#include "gl/capabilities.hpp"

namespace sk::gl {

struct WantedDevice {
  enum class Kind { Best, Gpu, NumberedGpu, Software, Renderer };
  Kind kind = Kind::Best;
  int number = 0;             ///< NumberedGpu
  std::string renderer;       ///< Renderer: a part of its name, lower-case

  /// "" and "gl" for the best, "gpu", "gpu:N", "software", or a part of a renderer's name. Throws sk::Error where N is no
  /// number.
  static WantedDevice parse(const std::string& text);

  bool mayBeSoftware() const { return kind != Kind::Gpu && kind != Kind::NumberedGpu; }
  /// Why a context that serves is not the one; empty where it is.
  std::string whyNot(const Capabilities& capabilities) const;
};

}  // namespace sk::gl
