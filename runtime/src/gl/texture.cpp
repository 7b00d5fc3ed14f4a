// SPDX-License-Identifier: MIT
//
// Creates textures and detects exhausted memory.

#include "gl/texture.hpp"

#include "gl/bound_state.hpp"

namespace sk::gl {

void deleteTexture(BoundState& bound, GLuint name) {
  glDeleteTextures(1, &name);
  bound.forgetTexture(name);
}

void setNearest(GLenum target) {
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
}

Texture::Texture(BoundState& bound, const Format& format, const TextureSize& size)
    : name_(bound.deletions, [] { return generated(glGenTextures); }), format_(&format), size_(size) {
  bound.textureToChange(name(), isLayered());
  const GLenum target = isLayered() ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
  const auto internalFormat = static_cast<GLint>(format.internalFormat);
  setNearest(target);
  bound.errors.setAside();
  if (isLayered()) {
    glTexImage3D(target, 0, internalFormat, size.width, size.height, size.layers, 0, format.tight.format,
                 format.tight.type, nullptr);
  } else {
    glTexImage2D(target, 0, internalFormat, size.width, size.height, 0, format.tight.format,
                 format.tight.type, nullptr);
  }
  if (bound.errors.takeNew() != GL_NO_ERROR) name_ = {};
}

void Texture::write(BoundState& bound, const Texels& rect, GLint layer, const void* texels) {
  bound.spoil();
  bound.textureToChange(name(), isLayered());
  const Transfer& tight = format_->tight;
  if (isLayered()) {
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, rect.x, rect.y, layer, rect.width, rect.height, 1, tight.format,
                    tight.type, texels);
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, rect.x, rect.y, rect.width, rect.height, tight.format, tight.type,
                    texels);
  }
}

void Texture::copyLayer(BoundState& bound, GLuint framebuffer, GLint layer, GLsizei width, GLsizei height) {
  bound.spoil();
  bound.readFramebuffer(framebuffer);
  bound.textureToChange(name(), true);
  glCopyTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, 0, 0, width, height);
}

std::size_t Texture::bytes() const {
  return static_cast<std::size_t>(size_.width) * static_cast<std::size_t>(rows()) * format_->texelBytes();
}

}  // namespace sk::gl
