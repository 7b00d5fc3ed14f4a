// SPDX-License-Identifier: MIT
//
// A scene in a window while it runs: drawn by OpenGL from the texture of a field's stream, which never visits host memory.
#pragma once

#include <string>

#include "scene.hpp"

namespace examples {

/// Until the window is closed. Keys: space stops and goes on, s makes one step, f shows the next field, + and - take more or
/// fewer steps for a picture, r begins anew, q and Escape end. Throws std::runtime_error where there is no display, for
/// a device that has no OpenGL, and where a number is not finite.
void runLive(const Scene& scene, const std::string& deviceName);

}  // namespace examples
