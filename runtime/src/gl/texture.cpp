// SPDX-License-Identifier: MIT
//
// Creates textures and detects exhausted memory.
// Creates framebuffers and reads from them.
#include "gl/texture.hpp"

#include <vector>

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
  setNearest(target);
  bound.errors.setAside();
  bound.isEs() ? takeImmutable(target) : take(target);
  if (bound.errors.takeNew() != GL_NO_ERROR) name_ = {};
}

void Texture::take(GLenum target) const {
  const auto internalFormat = static_cast<GLint>(format_->internalFormat);
  const Transfer& tight = format_->tight;
  if (isLayered()) {
    glTexImage3D(target, 0, internalFormat, size_.width, size_.height, size_.layers, 0, tight.format,
                 tight.type, nullptr);
  } else {
    glTexImage2D(target, 0, internalFormat, size_.width, size_.height, 0, tight.format, tight.type, nullptr);
  }
}

/// In ES, programs write images of no other textures.
void Texture::takeImmutable(GLenum target) const {
  if (isLayered()) {
    glTexStorage3D(target, 1, format_->internalFormat, size_.width, size_.height, size_.layers);
  } else {
    glTexStorage2D(target, 1, format_->internalFormat, size_.width, size_.height);
  }
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

void deleteFramebuffer(BoundState& bound, GLuint name) {
  glDeleteFramebuffers(1, &name);
  bound.forgetFramebuffer(name);
}

Framebuffer::Framebuffer(BoundState& bound, std::span<const GLuint> textures, bool isLayered)
    : name_(bound.deletions, [] { return generated(glGenFramebuffers); }) {
  bound.framebuffer(name());
  std::vector<GLenum> attachments;
  for (const GLuint texture : textures) {
    attachments.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size()));
    if (isLayered) {
      layered_.push_back(texture);
      glFramebufferTextureLayer(GL_FRAMEBUFFER, attachments.back(), texture, 0, 0);
    } else {
      glFramebufferTexture2D(GL_FRAMEBUFFER, attachments.back(), GL_TEXTURE_2D, texture, 0);
    }
  }
  glDrawBuffers(static_cast<GLsizei>(attachments.size()), attachments.data());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
}

void Framebuffer::selectLayer(BoundState& bound, GLint layer) {
  bound.spoil();
  bound.framebuffer(name());
  if (layer == layer_) {
    return;
  }
  GLenum attachment = GL_COLOR_ATTACHMENT0;
  for (const GLuint texture : layered_) {
    glFramebufferTextureLayer(GL_FRAMEBUFFER, attachment++, texture, 0, layer);
  }
  layer_ = layer;
}

void Framebuffer::read(BoundState& bound, const Transfer& transfer, GLint x, GLint y, GLsizei width,
                       GLsizei height, void* texels) const {
  bound.spoil();
  bound.framebuffer(name());
  glReadPixels(x, y, width, height, transfer.format, transfer.type, texels);
}

bool Framebuffer::readsOnEs(BoundState& bound, const Transfer& transfer) const {
  bound.framebuffer(name());
  GLint format = 0;
  GLint type = 0;
  glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_FORMAT, &format);
  glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_TYPE, &type);
  return static_cast<GLenum>(format) == transfer.format && static_cast<GLenum>(type) == transfer.type;
}

}  // namespace sk::gl
