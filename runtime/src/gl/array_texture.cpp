// SPDX-License-Identifier: MIT
//
// Making an array texture, and filling its layers.
#include "gl/array_texture.hpp"

#include "gl/bound_state.hpp"
#include "gl/errors.hpp"

namespace sk::gl {

ArrayTexture::ArrayTexture(BoundState& bound, const Format& format, GLsizei width, GLsizei height,
                           GLsizei layers)
    : name_(newTexture()) {
  bound.arrayTextureToChange(name());
  setNearest(GL_TEXTURE_2D_ARRAY);
  dropErrors();
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(format.internalFormat), width, height, layers, 0,
               format.tight.format, format.tight.type, nullptr);
  if (takeError() != GL_NO_ERROR) {
    bound.arrayTextureToChange(0);
    name_ = {};
  }
}

void ArrayTexture::copyLayer(BoundState& bound, GLuint framebuffer, GLint layer, GLsizei width,
                             GLsizei height) {
  bound.readFramebuffer(framebuffer);
  bound.arrayTextureToChange(name());
  glCopyTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, 0, 0, width, height);
}

}  // namespace sk::gl
