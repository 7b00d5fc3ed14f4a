// SPDX-License-Identifier: MIT
//
// What the current context supports, whether this is sufficient, and what the driver tells about the GPU's memory. OpenGL
// itself has no query for the memory; two extensions have.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "gl/context.hpp"
#include "gl/known_devices.hpp"

namespace sk::gl {

class BoundState;

struct Capabilities {
  Api api = Api::Gl;
  int version = 0;  ///< 10 * major + minor
  bool isCompatibility = false;  ///< GL with the fixed-function pipeline
  RendererKind kind = RendererKind::Integrated;
  bool isSoftware = false;  ///< kind is Software
  bool blendsFloats = false;  ///< can blend 32-bit floats
  bool hasDoubles = false;  ///< GLSL has double (GL_ARB_gpu_shader_fp64)
  bool hasPrecise = false;  ///< GLSL 3.30, or ESSL 3.10, has `precise` (GL_ARB_gpu_shader5, or the like)
  bool filtersFloats = false;  ///< can filter 32-bit floats linearly
  /// Has compute programs of GLSL 4.30 or ESSL 3.10, within the limits below, whose work groups of 256 invocations have 32 KiB of
  /// shared memory.
  bool hasCompute = false;
  bool storesAllFormats = false;  ///< compute programs write images of all formats
  bool hasImageAtomics = false;  ///< compute programs have atomic operations on images
  bool storesFromDraws = false;  ///< fragment programs write buffers at bindings 0 and 1
  /// Compute programs have subgroups of 32 invocations with votes, sums and shuffles, and 48 KiB of shared memory in a work group.
  bool hasSubgroups = false;
  bool mapsStorage = false;  ///< maps buffers while programs use them
  bool hasClipControl = false;  ///< the origin of y can be chosen
  bool hasLabels = false;  ///< has names of objects for debuggers (KHR_debug)
  bool reportsResets = false;  ///< has glGetGraphicsResetStatus
  bool isDebugged = false;  ///< a debugger is attached, or the context is a debug context
  std::vector<GLenum> binaryFormats;  ///< formats of program binaries that the driver supports; may be empty
  std::string renderer;
  std::string driver;  ///< GL_VERSION, as reported by the driver
  std::string shadingLanguage;  ///< GL_SHADING_LANGUAGE_VERSION, likewise
  int textureSize = 0;  ///< largest texture and viewport
  int textureLayers = 0;  ///< layers of an array texture
  int drawBuffers = 0;
  int textureUnits = 0;  ///< at most maxTextureUnits
  int uniformComponents = 0;  ///< components of a program's uniforms
  int images = 0;  ///< images that a compute program writes; at most drawBuffers
  int outputResources = 0;  ///< images and storage buffers of a compute program, together
  std::int64_t storageBytes = 0;  ///< of a buffer that compute programs write
};

/// Most planes that one pass writes, on any device.
inline constexpr int maxDrawBuffers = 16;

/// Queries the current context.
Capabilities readCapabilities();

/// Why the current context is not sufficient, as text to follow "because"; empty if it is sufficient. Tests
/// drawing to each format, after which framebuffer 0 and unit 0 must be restored.
std::string whyUnfit(const Capabilities& capabilities, BoundState& bound);

struct MemoryInfo {
  std::optional<std::int64_t> whole;  ///< bytes; empty if the driver does not tell
  std::optional<std::int64_t> available;  ///< bytes that are free now, likewise
};

/// Queries the current context: GL_NVX_gpu_memory_info has both numbers, GL_ATI_meminfo has those that are free.
MemoryInfo readMemoryInfo();

}  // namespace sk::gl
