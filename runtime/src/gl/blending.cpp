// SPDX-License-Identifier: MIT
//
// Sets up blending and saves the application's settings.
#include "gl/blending.hpp"

#include <epoxy/gl.h>

namespace sk::gl {

namespace {

constexpr std::array<GLenum, 6> names = {GL_BLEND_EQUATION_RGB, GL_BLEND_EQUATION_ALPHA, GL_BLEND_SRC_RGB,
                                         GL_BLEND_DST_RGB,      GL_BLEND_SRC_ALPHA,      GL_BLEND_DST_ALPHA};

/// Whether each draw buffer has its own equations and factors.
bool hasIndexedBlending(const Capabilities& c) { return c.version >= (c.api == Api::Gl ? 40 : 32); }

GLenum equationOf(Blend blend) {
  switch (blend) {
    case Blend::None:
    case Blend::Add: break;
    case Blend::Min: return GL_MIN;
    case Blend::Max: return GL_MAX;
  }
  return GL_FUNC_ADD;
}

}  // namespace

Blending::Blending(const Capabilities& capabilities, Blend blend, bool isApplicationContext)
    : capabilities_(capabilities), isOn_(blend != Blend::None), isKept_(isOn_ && isApplicationContext) {
  if (!isOn_) {
    return;
  }
  const int buffers = hasIndexedBlending(capabilities) ? capabilities.drawBuffers : 1;
  for (int buffer = 0; isKept_ && buffer < buffers; ++buffer) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      GLint& value = kept_[static_cast<std::size_t>(buffer)][i];
      buffers > 1 ? glGetIntegeri_v(names[i], static_cast<GLuint>(buffer), &value)
                  : glGetIntegerv(names[i], &value);
    }
  }
  glBlendEquation(equationOf(blend));
  glBlendFunc(GL_ONE, GL_ONE);
  glEnable(GL_BLEND);
}

Blending::~Blending() {
  if (!isOn_) {
    return;
  }
  glDisable(GL_BLEND);
  if (!isKept_) {
    return;
  }
  const auto value = [&](int buffer, std::size_t i) {
    return static_cast<GLenum>(kept_[static_cast<std::size_t>(buffer)][i]);
  };
  if (!hasIndexedBlending(capabilities_)) {
    glBlendEquationSeparate(value(0, 0), value(0, 1));
    glBlendFuncSeparate(value(0, 2), value(0, 3), value(0, 4), value(0, 5));
    return;
  }
  for (int buffer = 0; buffer < capabilities_.drawBuffers; ++buffer) {
    const auto index = static_cast<GLuint>(buffer);
    glBlendEquationSeparatei(index, value(buffer, 0), value(buffer, 1));
    glBlendFuncSeparatei(index, value(buffer, 2), value(buffer, 3), value(buffer, 4), value(buffer, 5));
  }
}

void ColorMaskScope::set(const ColorMask& mask) {
  const auto value = [&](int c) { return static_cast<GLboolean>(mask[static_cast<std::size_t>(c)]); };
  glColorMask(value(0), value(1), value(2), value(3));
}

}  // namespace sk::gl
