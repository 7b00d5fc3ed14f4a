// SPDX-License-Identifier: MIT
//
// What the current context can do, and whether that is enough for us.
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
  bool isCompatibility = false;  ///< GL with the fixed functions
  bool isSoftware = false;
  bool blendsFloats = false;     ///< of 32 bits
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
  std::string driver;  ///< GL_VERSION, as the driver words it
  std::string shadingLanguage;  ///< GL_SHADING_LANGUAGE_VERSION, likewise
  int textureSize = 0;  ///< also as a viewport
  int textureLayers = 0;  ///< of an array texture
  int drawBuffers = 0;
  int textureUnits = 0;  ///< at most maxTextureUnits
  int uniformComponents = 0;  ///< of a program
};

/// Planes that one pass may write at most, whatever the device allows.
inline constexpr int maxDrawBuffers = 16;

/// Asks the current context.
Capabilities readCapabilities();

/// Why the current context cannot serve, in words that follow "because"; empty where it can. Tries
/// to draw to each format, which needs no state but framebuffer 0 and unit 0 put back afterwards.
std::string whyUnfit(const Capabilities& capabilities, BoundState& bound);

}  // namespace sk::gl
