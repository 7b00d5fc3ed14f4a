// SPDX-License-Identifier: MIT
//
// What the driver tells about the GPU's memory. OpenGL itself has no query for it; two extensions have.
#pragma once

#include <cstdint>
#include <optional>

namespace sk::gl {

struct MemoryInfo {
  std::optional<std::int64_t> whole;      ///< bytes; empty if the driver does not tell
  std::optional<std::int64_t> available;  ///< bytes that are free now, likewise
};

/// Queries the current context: GL_NVX_gpu_memory_info has both numbers, GL_ATI_meminfo has those that are free.
MemoryInfo readMemoryInfo();

}  // namespace sk::gl
