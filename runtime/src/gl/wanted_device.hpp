// SPDX-License-Identifier: MIT
//
// A user's request for a device, and whether a context satisfies it.
#pragma once

#include <string>

#include "gl/capabilities.hpp"

namespace sk::gl {

struct WantedDevice {
  enum class Kind { Best, Gpu, NumberedGpu, Software, Renderer };
  Kind kind = Kind::Best;
  int number = 0;             ///< NumberedGpu
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

}  // namespace sk::gl
