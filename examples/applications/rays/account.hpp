// SPDX-License-Identifier: MIT
//
// Compares the cost of a scene's specialized kernels with kernels that support every feature, measured on the scene itself.
#pragma once

#include <string>

#include "engine.hpp"
#include "scene.hpp"
#include "support/verification.hpp"

namespace rays {

struct Account {
  std::string text;  ///< one line
  /// Both make one picture: what is left out is what the scene does not use.
  examples::Verification agreement;
};

/// Renders some samples of the picture with both kernels, in turn.
Account accountFor(Engine& engine, const Scene& scene);

}  // namespace rays
