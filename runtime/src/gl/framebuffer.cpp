// SPDX-License-Identifier: MIT
//
// Creates framebuffers and reads from them.
#include "gl/framebuffer.hpp"

#include <vector>

#include "gl/bound_state.hpp"

namespace sk::gl {

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
