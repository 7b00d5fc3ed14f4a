// SPDX-License-Identifier: MIT
//
// What the current context supports, and whether this is sufficient.
#pragma once

#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "gl/context.hpp"

namespace sk::gl {

class BoundState;

struct Capabilities {
  Api api = Api::Gl;
  int version = 0;               ///< 10 * major + minor
  bool isCompatibility = false;  ///< GL with the fixed-function pipeline
  bool isSoftware = false;
  bool blendsFloats = false;  ///< can blend 32-bit floats
  bool hasDoubles = false;       ///< GLSL has double (GL_ARB_gpu_shader_fp64)
  bool hasPrecise = false;       ///< GLSL 3.30 has `precise` (GL_ARB_gpu_shader5)
  bool filtersFloats = false;    ///< of 32 bits, linearly
  bool hasCompute = false;       ///< compute programs of GLSL 4.30, within the limits below
  bool hasClipControl = false;   ///< where y is 0 may be chosen
  bool hasLabels = false;        ///< objects may have names for debuggers (KHR_debug)
  bool tellsResets = false;      ///< glGetGraphicsResetStatus
  bool isDebugged = false;       ///< a debugger is there, or the context is one for debugging
  std::vector<GLenum> binaryFormats;  ///< of programs that the driver gives and takes; none where it does not
  std::string renderer;
  std::string driver;  ///< GL_VERSION, as reported by the driver
  std::string shadingLanguage;  ///< GL_SHADING_LANGUAGE_VERSION, likewise
  int textureSize = 0;  ///< largest texture and viewport
  int textureLayers = 0;  ///< layers of an array texture
  int drawBuffers = 0;
  int textureUnits = 0;  ///< at most maxTextureUnits
  int uniformComponents = 0;  ///< components of a program's uniforms
};

/// Most planes that one pass writes, on any device.
inline constexpr int maxDrawBuffers = 16;

/// Queries the current context.
Capabilities readCapabilities();

/// Why the current context is not sufficient, as text to follow "because"; empty if it is sufficient. Tests
/// drawing to each format, after which framebuffer 0 and unit 0 must be restored.
std::string whyUnfit(const Capabilities& capabilities, BoundState& bound);

}  // namespace sk::gl
