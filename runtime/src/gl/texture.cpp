// SPDX-License-Identifier: MIT
//
// Making a texture, and finding out whether there was memory for it.
#include "gl/texture.hpp"

#include "gl/bound_state.hpp"
#include "gl/errors.hpp"

namespace sk::gl {

GLuint newTexture() {
  GLuint name = 0;
  glGenTextures(1, &name);
  return name;
}

void deleteTexture(GLuint name) { glDeleteTextures(1, &name); }

void setNearest(GLenum target) {
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

Texture::Texture(BoundState& bound, const Format& format, GLsizei width, GLsizei height)
    : name_(newTexture()), format_(&format), width_(width), height_(height) {
  bound.textureToChange(name());
  setNearest(GL_TEXTURE_2D);
  dropErrors();
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format.internalFormat), width, height, 0,
               format.tight.format, format.tight.type, nullptr);
  if (takeError() != GL_NO_ERROR) {
    bound.texture(0, 0);
    name_ = {};
  }
}

void Texture::write(BoundState& bound, GLint x, GLint y, GLsizei width, GLsizei height, const void* texels) {
  bound.textureToChange(name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, x, y, width, height, format_->tight.format, format_->tight.type, texels);
}

std::size_t Texture::bytes() const {
  return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) * format_->texelBytes();
}

}  // namespace sk::gl
