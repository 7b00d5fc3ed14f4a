// SPDX-License-Identifier: MIT
//
// A scene in a window that becomes better as long as nobody moves.
#pragma once

#include <string>

#include "scene.hpp"

namespace rays {

/// Until the window is closed. The mouse turns the camera about the point that it looks at, the wheel goes nearer and farther; space stops and goes
/// on, r begins anew, + and - change the exposure, q and Escape end. `device` is native or reference, or the window's own OpenGL is taken. Throws
/// std::runtime_error where there is no display.
void runLive(Scene& scene, const std::string& device);

}  // namespace rays
