// SPDX-License-Identifier: MIT
#include "gl/color_mask.hpp"

#include <epoxy/gl.h>

namespace sk::gl {

void ColorMaskScope::set(const ColorMask& mask) {
  const auto value = [&](int c) { return static_cast<GLboolean>(mask[static_cast<std::size_t>(c)]); };
  glColorMask(value(0), value(1), value(2), value(3));
}

}  // namespace sk::gl
