// SPDX-License-Identifier: MIT
#include "gl_device/memory/kept_bytes.hpp"

#include <algorithm>
#include <cstdint>

namespace sk {

std::size_t keptBytesOf(const gl::MemoryInfo& memory) {
  constexpr std::int64_t least = std::int64_t{256} << 20;
  return static_cast<std::size_t>(std::max(memory.whole.value_or(0) / 16, least));
}

std::size_t keptBytesOn(const gl::Context& context, const gl::Capabilities& capabilities) {
  if (capabilities.isSoftware) return keptBytesOf({});
  const gl::CurrentScope current(context);
  return keptBytesOf(gl::readMemoryInfo());
}

}  // namespace sk
