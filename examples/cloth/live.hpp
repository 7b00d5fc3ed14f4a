// SPDX-License-Identifier: MIT
//
// A scene in a window, as long as somebody looks at it.
#pragma once

#include <string>

#include <sk/options.hpp>

#include "filming.hpp"
#include "scene.hpp"

namespace examples {

/// Runs at the pace of the clock where the device is fast enough. `device` is native or reference, or the window's own OpenGL
/// is taken. Throws std::runtime_error where there is no display, or where a number breaks.
void runLive(const Scene& scene, sk::Precision precision, const std::string& device, PictureSize size);

}  // namespace examples
