// SPDX-License-Identifier: MIT
//
// The GLSL by which a scene is drawn: cloth straight from the buffers of its points, bodies, the ground, and the last pass that
// makes a picture of it.
#pragma once

#include <string>

namespace examples::shaders {

/// Depth alone, as the light sees it.
std::string clothDepthVertex();
std::string bodyDepthVertex();
std::string depthFragment();

std::string clothVertex();
std::string bodyVertex();
std::string groundVertex();
std::string clothFragment();
std::string bodyFragment();
std::string groundFragment();

/// The whole screen.
std::string screenVertex();
std::string backgroundFragment();
/// factor x factor texels to a pixel, as light, then sRGB.
std::string resolveFragment();

}  // namespace examples::shaders
