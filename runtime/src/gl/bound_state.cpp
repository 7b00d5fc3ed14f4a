// SPDX-License-Identifier: MIT
//
// Implements the less frequent of the tracked bindings.
#include "gl/bound_state.hpp"

#include <algorithm>

namespace sk::gl {

void BoundState::drawFramebuffer(GLuint name) {
  spoil();
  if (drawFramebuffer_ != name) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, name);
    drawFramebuffer_ = name;
  }
}

void BoundState::readFramebuffer(GLuint name) {
  spoil();
  if (readFramebuffer_ != name) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, name);
    readFramebuffer_ = name;
  }
}

void BoundState::bindSampler(int unit, GLuint name) {
  glBindSampler(static_cast<GLuint>(unit), name);
  samplers_[static_cast<std::size_t>(unit)] = name;
}

void BoundState::forget() {
  program_ = vertexArray_ = drawFramebuffer_ = readFramebuffer_ = unknown;
  viewport_ = {-1, -1, -1, -1};
  activeUnit_ = -1;
  textures_ = arrayTextures_ = samplers_ = unknownUnits();
  images_ = unknownUnits<maxImageUnits>();
  storage_ = loopStorage_ = unknown;
}

void BoundState::forgetProgram(GLuint name) {
  for (CommandLog* const log : kept_) log->forgetProgram(name);
  if (program_ == name) program_ = unknown;
}

void BoundState::forgetTexture(GLuint name) {
  for (CommandLog* const log : kept_) log->forgetTexture(name);
  for (auto* units : {&textures_, &arrayTextures_}) std::ranges::replace(*units, name, unknown);
  std::ranges::replace(images_, name, unknown);
}

void BoundState::forgetFramebuffer(GLuint name) {
  for (CommandLog* const log : kept_) log->forgetFramebuffer(name);
  if (drawFramebuffer_ == name) drawFramebuffer_ = unknown;
  if (readFramebuffer_ == name) readFramebuffer_ = unknown;
}

void BoundState::forgetStorage(GLuint name) {
  for (CommandLog* const log : kept_) log->forgetStorage(name);
  if (storage_ == name) storage_ = unknown;
  if (loopStorage_ == name) loopStorage_ = unknown;
}

void BoundState::bindImage(int unit, GLuint name, GLenum format, GLenum access) {
  keepImage(static_cast<std::size_t>(unit));
  glBindImageTexture(static_cast<GLuint>(unit), name, 0, GL_TRUE, 0, access, format);
}

/// Saves the application's image binding before its first change.
void BoundState::keepImage(std::size_t unit) {
  KeptImage& kept = keptImages_[unit];
  if (!isApplications_ || kept.kept) {
    return;
  }
  const auto index = static_cast<GLuint>(unit);
  glGetIntegeri_v(GL_IMAGE_BINDING_NAME, index, &kept.name);
  glGetIntegeri_v(GL_IMAGE_BINDING_LEVEL, index, &kept.level);
  glGetIntegeri_v(GL_IMAGE_BINDING_LAYERED, index, &kept.isLayered);
  glGetIntegeri_v(GL_IMAGE_BINDING_LAYER, index, &kept.layer);
  glGetIntegeri_v(GL_IMAGE_BINDING_ACCESS, index, &kept.access);
  glGetIntegeri_v(GL_IMAGE_BINDING_FORMAT, index, &kept.format);
  kept.kept = true;
}

void BoundState::bindStorage(GLuint name) {
  keepStorage();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, name);
  storage_ = name;
}

void BoundState::bindLoopStorage(GLuint name) {
  keepStorage();
  if (isApplications_ && !std::exchange(keptStorage_.isLoopsKept, true)) keptStorage_.loops = rangeAt(1);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, name);
  loopStorage_ = name;
  reselectStorage();
}

/// Binds the buffer at binding 0 at the generic binding again. If it is not known, it will be bound before it is used.
void BoundState::reselectStorage() {
  if (storage_ != unknown) glBindBuffer(GL_SHADER_STORAGE_BUFFER, storage_);
}

/// Saves the application's buffer at binding 0 and at the generic binding before their first change.
void BoundState::keepStorage() {
  if (!isApplications_ || keptStorage_.kept) {
    return;
  }
  glGetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &keptStorage_.selected);
  keptStorage_.first = rangeAt(0);
  keptStorage_.kept = true;
}

BoundState::KeptRange BoundState::rangeAt(GLuint binding) {
  KeptRange range;
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, binding, &range.name);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, binding, &range.start);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, binding, &range.size);
  return range;
}

void BoundState::restoreAt(GLuint binding, const KeptRange& range) {
  const auto name = static_cast<GLuint>(range.name);
  if (range.size == 0) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name);
  } else {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, name, static_cast<GLintptr>(range.start),
                      static_cast<GLsizeiptr>(range.size));
  }
}

void BoundState::restoreStorage() {
  if (!keptStorage_.kept) {
    return;
  }
  restoreAt(0, keptStorage_.first);
  if (keptStorage_.isLoopsKept) restoreAt(1, keptStorage_.loops);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(keptStorage_.selected));
  keptStorage_ = {};
}

void BoundState::bindTexture(int unit, GLuint name, bool isArray) {
  const auto slot = static_cast<std::size_t>(unit);
  activateUnit(unit);
  keepUnit(slot);
  glBindTexture(isArray ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, name);
  (isArray ? arrayTextures_ : textures_)[slot] = name;
}

void BoundState::activateUnit(int unit) {
  if (activeUnit_ != unit) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    activeUnit_ = unit;
  }
}

/// Saves the application's texture and sampler of the active unit before their first change.
void BoundState::keepUnit(std::size_t unit) {
  KeptUnit& kept = keptUnits_[unit];
  if (!isApplications_ || kept.kept) {
    return;
  }
  glGetIntegerv(GL_TEXTURE_BINDING_2D, &kept.texture);
  glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &kept.arrayTexture);
  glGetIntegerv(GL_SAMPLER_BINDING, &kept.sampler);
  kept.kept = true;
}

void BoundState::setViewport(const std::array<GLint, 4>& rectangle) const {
  if (hasManyViewports_) {
    glViewportIndexedf(0, static_cast<GLfloat>(rectangle[0]), static_cast<GLfloat>(rectangle[1]),
                       static_cast<GLfloat>(rectangle[2]), static_cast<GLfloat>(rectangle[3]));
  } else {
    glViewport(rectangle[0], rectangle[1], rectangle[2], rectangle[3]);
  }
}

void BoundState::enterApplication(bool hasManyViewports) {
  forget();
  isApplications_ = true;
  hasManyViewports_ = hasManyViewports;
}

void BoundState::leaveApplication(GLint activeUnit) {
  for (std::size_t unit = 0; unit < keptUnits_.size(); ++unit) {
    KeptUnit& kept = keptUnits_[unit];
    if (kept.kept) {
      activateUnit(static_cast<int>(unit));
      glBindTexture(GL_TEXTURE_2D, static_cast<GLuint>(kept.texture));
      glBindTexture(GL_TEXTURE_2D_ARRAY, static_cast<GLuint>(kept.arrayTexture));
      glBindSampler(static_cast<GLuint>(unit), static_cast<GLuint>(kept.sampler));
      kept = {};
    }
  }
  for (std::size_t unit = 0; unit < keptImages_.size(); ++unit) {
    KeptImage& kept = keptImages_[unit];
    if (kept.kept) {
      glBindImageTexture(static_cast<GLuint>(unit), static_cast<GLuint>(kept.name), kept.level,
                         kept.isLayered != 0 ? GL_TRUE : GL_FALSE, kept.layer,
                         static_cast<GLenum>(kept.access), static_cast<GLenum>(kept.format));
      kept = {};
    }
  }
  restoreStorage();
  glActiveTexture(static_cast<GLenum>(activeUnit));
  isApplications_ = hasManyViewports_ = false;
  forget();
}

}  // namespace sk::gl
