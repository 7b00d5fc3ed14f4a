// SPDX-License-Identifier: MIT
#include "gl/memory_info.hpp"

#include <array>

#include <epoxy/gl.h>

namespace sk::gl {

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
