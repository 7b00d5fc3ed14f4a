// SPDX-License-Identifier: MIT
//
// Queries a context's limits and its memory, and tests the formats.

#include "gl/capabilities.hpp"

#include <array>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "gl/bound_state.hpp"
#include "gl/texture.hpp"

namespace sk::gl {

namespace {

std::string stringOf(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? "" : text;
}

int integerOf(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

int largestTexture() {
  GLint viewport[2] = {0, 0};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  return std::min({integerOf(GL_MAX_TEXTURE_SIZE), viewport[0], viewport[1]});
}

/// Whether compute programs have subgroups of 32 invocations that are all full. GL promises that of no driver: others may run
/// fewer invocations together than they report. NVIDIA's does not.
bool hasFullSubgroups() {
  if (!epoxy_has_gl_extension("GL_KHR_shader_subgroup") || !stringOf(GL_VENDOR).starts_with("NVIDIA"))
    return false;
  // the names of GL_KHR_shader_subgroup, which libepoxy may not know
  constexpr GLenum subgroupSize = 0x9532, subgroupStages = 0x9533, subgroupFeatures = 0x9534;
  constexpr GLint basic = 1, arithmetic = 4, ballot = 8, shuffle = 16, relativeShuffle = 32;
  constexpr GLint features = basic | arithmetic | ballot | shuffle | relativeShuffle;
  return integerOf(subgroupSize) == 32 && (integerOf(subgroupStages) & GL_COMPUTE_SHADER_BIT) != 0 &&
         (integerOf(subgroupFeatures) & features) == features &&
         integerOf(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE) >= 48 << 10;
}

/// The limits of compute programs, which GL and ES guarantee to a different extent.
void readComputeLimits(Capabilities& found) {
  found.outputResources = integerOf(GL_MAX_COMBINED_SHADER_OUTPUT_RESOURCES);
  found.images =
      std::min({integerOf(GL_MAX_COMPUTE_IMAGE_UNIFORMS), integerOf(GL_MAX_IMAGE_UNITS), found.drawBuffers});
  found.uniformComponents = std::min(found.uniformComponents, integerOf(GL_MAX_COMPUTE_UNIFORM_COMPONENTS));
  GLint64 storageBytes = 0;
  glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &storageBytes);
  found.storageBytes = storageBytes;
}

/// Compute programs of ES 3.1. They may write fewer planes than fragment programs, and images of fewer formats; those who run
/// them check that.
void readComputeOfEs(Capabilities& found) {
  constexpr int invocations = 256, sharedBytes = 32 << 10;
  found.hasCompute = integerOf(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS) >= invocations &&
                     integerOf(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE) >= sharedBytes &&
                     integerOf(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS) >= found.textureUnits;
  if (!found.hasCompute) return;
  readComputeLimits(found);
  found.images = std::min(found.images, found.outputResources);
  found.storesAllFormats = epoxy_has_gl_extension("GL_NV_image_formats");
  found.hasImageAtomics = epoxy_has_gl_extension("GL_OES_shader_image_atomic");
}

/// Whether compute programs can replace fragment programs of the same limits; uniform limits are then those
/// of both.
void readCompute(Capabilities& found) {
  if (found.api == Api::Es && found.version >= 31) readComputeOfEs(found);
  if (found.api != Api::Gl || found.version < 43) return;
  found.hasCompute = integerOf(GL_MAX_COMPUTE_IMAGE_UNIFORMS) >= found.drawBuffers &&
                     integerOf(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS) >= found.textureUnits;
  if (!found.hasCompute) return;
  readComputeLimits(found);
  found.images = found.drawBuffers;
  found.storesAllFormats = found.hasImageAtomics = true;
  found.hasSubgroups = hasFullSubgroups();
  found.mapsStorage = found.version >= 44 || epoxy_has_gl_extension("GL_ARB_buffer_storage");
}

/// Fragment programs of GLSL 3.30, and of ESSL 3.10.
bool storesFromDraws(const Capabilities& found) {
  const bool isGl = found.api == Api::Gl;
  if (isGl ? found.version < 43 && !(epoxy_has_gl_extension("GL_ARB_shader_storage_buffer_object") &&
                                     epoxy_has_gl_extension("GL_ARB_shading_language_420pack"))
           : found.version < 31)
    return false;
  return integerOf(GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS) >= 2 &&
         integerOf(GL_MAX_SHADER_STORAGE_BUFFER_BINDINGS) >= 2;
}

std::vector<GLenum> binaryFormats(const Capabilities& found) {
  if (found.api == Api::Gl && found.version < 41 && !epoxy_has_gl_extension("GL_ARB_get_program_binary")) {
    return {};
  }
  std::vector<GLint> formats(static_cast<std::size_t>(integerOf(GL_NUM_PROGRAM_BINARY_FORMATS)));
  if (!formats.empty()) glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats.data());
  return {formats.begin(), formats.end()};
}

bool canDrawTo(const Format& format, BoundState& bound) {
  const DeletionScope deleted(bound);
  const Texture texture(bound, format, {1, 1});
  if (texture.name() == 0) {
    return false;
  }
  const GLuint names[] = {texture.name()};
  const Framebuffer framebuffer(bound, names, false);
  return Framebuffer::isComplete();
}

}  // namespace

Capabilities readCapabilities() {
  Capabilities found;
  found.api = epoxy_is_desktop_gl() ? Api::Gl : Api::Es;
  found.version = epoxy_gl_version();
  found.renderer = stringOf(GL_RENDERER);
  found.driver = stringOf(GL_VERSION);
  found.shadingLanguage = stringOf(GL_SHADING_LANGUAGE_VERSION);
  found.kind = kindOf(found.renderer);
  found.isSoftware = found.kind == RendererKind::Software;
  if (found.version < 30) {
    return found;
  }
  found.blendsFloats = found.api == Api::Gl || epoxy_has_gl_extension("GL_EXT_float_blend");
  found.hasDoubles = found.api == Api::Gl && epoxy_has_gl_extension("GL_ARB_gpu_shader_fp64");
  found.hasPrecise = found.api == Api::Gl
                         ? epoxy_has_gl_extension("GL_ARB_gpu_shader5")
                         : found.version >= 31 && (epoxy_has_gl_extension("GL_EXT_gpu_shader5") ||
                                                   epoxy_has_gl_extension("GL_OES_gpu_shader5"));
  found.filtersFloats = found.api == Api::Gl || epoxy_has_gl_extension("GL_OES_texture_float_linear");
  found.hasClipControl = found.api == Api::Gl
                             ? found.version >= 45 || epoxy_has_gl_extension("GL_ARB_clip_control")
                             : epoxy_has_gl_extension("GL_EXT_clip_control");
  found.hasLabels =
      found.version >= (found.api == Api::Gl ? 43 : 32) || epoxy_has_gl_extension("GL_KHR_debug");
  found.isDebugged = epoxy_has_gl_extension("GL_EXT_debug_tool") ||
                     (found.hasLabels && (integerOf(GL_CONTEXT_FLAGS) & GL_CONTEXT_FLAG_DEBUG_BIT) != 0);
  found.reportsResets =
      found.version >= (found.api == Api::Gl ? 45 : 32) || epoxy_has_gl_extension("GL_KHR_robustness");
  found.binaryFormats = binaryFormats(found);
  if (found.api == Api::Gl && found.version >= 32) {
    found.isCompatibility = (integerOf(GL_CONTEXT_PROFILE_MASK) & GL_CONTEXT_COMPATIBILITY_PROFILE_BIT) != 0;
  }
  found.textureSize = largestTexture();
  found.textureLayers = integerOf(GL_MAX_ARRAY_TEXTURE_LAYERS);
  found.drawBuffers =
      std::min({integerOf(GL_MAX_DRAW_BUFFERS), integerOf(GL_MAX_COLOR_ATTACHMENTS), maxDrawBuffers});
  found.textureUnits = std::min(integerOf(GL_MAX_TEXTURE_IMAGE_UNITS), maxTextureUnits);
  found.uniformComponents = found.api == Api::Gl ? integerOf(GL_MAX_FRAGMENT_UNIFORM_COMPONENTS)
                                                 : 4 * integerOf(GL_MAX_FRAGMENT_UNIFORM_VECTORS);
  readCompute(found);
  found.storesFromDraws = storesFromDraws(found);
  return found;
}

std::string whyUnfit(const Capabilities& capabilities, BoundState& bound) {
  const bool isGl = capabilities.api == Api::Gl;
  const int needed = isGl ? 33 : 30;
  if (capabilities.version < needed) {
    return fmt::format("it offers {} {}.{} ({}), and {} is needed", isGl ? "OpenGL" : "OpenGL ES",
                       capabilities.version / 10, capabilities.version % 10, capabilities.driver,
                       isGl ? "3.3" : "3.0");
  }
  if (!isGl && !epoxy_has_gl_extension("GL_EXT_color_buffer_float")) {
    return "it cannot draw to float textures: GL_EXT_color_buffer_float is missing";
  }
  std::string missing;
  for (const Format& format : formats()) {
    if (!canDrawTo(format, bound)) {
      missing += missing.empty() ? "" : ", ";
      missing += format.name;
    }
  }
  bound.framebuffer(0);
  bound.texture(0, 0, false);
  bound.forget();
  static_cast<void>(bound.errors.take());
  return missing.empty() ? "" : "it cannot draw to textures of format " + missing;
}

namespace {

/// A driver that does not know a number leaves 0.
std::optional<std::int64_t> bytesOf(GLint kibibytes) {
  if (kibibytes <= 0) return std::nullopt;
  return std::int64_t{1024} * kibibytes;
}

std::optional<std::int64_t> bytesOf(GLenum query) {
  std::array<GLint, 4>
      kibibytes{};  // of ATI_meminfo: the pool's free bytes, its largest block, and the same of host memory
  glGetIntegerv(query, kibibytes.data());
  return bytesOf(kibibytes[0]);
}

}  // namespace

MemoryInfo readMemoryInfo() {
  if (epoxy_has_gl_extension("GL_NVX_gpu_memory_info"))
    return {bytesOf(GLenum{GL_GPU_MEMORY_INFO_TOTAL_AVAILABLE_MEMORY_NVX}),
            bytesOf(GLenum{GL_GPU_MEMORY_INFO_CURRENT_AVAILABLE_VIDMEM_NVX})};
  if (epoxy_has_gl_extension("GL_ATI_meminfo"))
    return {std::nullopt, bytesOf(GLenum{GL_TEXTURE_FREE_MEMORY_ATI})};
  return {};
}

}  // namespace sk::gl
