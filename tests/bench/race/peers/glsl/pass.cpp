// SPDX-License-Identifier: MIT
#include "peers/glsl/pass.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace race {

Texture::Texture(std::int64_t width, std::int64_t height, int channels, const float* texels)
    : width_(static_cast<int>(width)), height_(static_cast<int>(height)), channels_(channels) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
  if (width > largest || height > largest) {
    throw std::runtime_error(fmt::format("textures have {0} x {0} texels at most", largest));
  }
  while (glGetError() != GL_NO_ERROR) {
  }
  glGenTextures(1, &name_);
  glBindTexture(GL_TEXTURE_2D, name_);
  glTexImage2D(GL_TEXTURE_2D, 0, channels == 1 ? GL_R32F : GL_RGBA32F, width_, height_, 0,
               channels == 1 ? GL_RED : GL_RGBA, GL_FLOAT, texels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, name_, 0);
  if (glGetError() != GL_NO_ERROR || glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error(fmt::format("no texture of {} x {} texels could be had", width, height));
  }
}

Texture::~Texture() {
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteTextures(1, &name_);
}

void Texture::bindAsTarget() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
}

std::vector<float> Texture::read() const {
  std::vector<float> texels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
                            static_cast<std::size_t>(channels_));
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glReadPixels(0, 0, width_, height_, channels_ == 1 ? GL_RED : GL_RGBA, GL_FLOAT, texels.data());
  return texels;
}

PassProgram::PassProgram(const std::string& text) : name_(bench::linkedProgram(text.c_str())) {
  glGenVertexArrays(1, &array_);
  glUseProgram(name_);
  for (int unit = 0; unit < 4; ++unit) {
    glUniform1i(glGetUniformLocation(name_, fmt::format("s{}", unit).c_str()), unit);
  }
}

PassProgram::~PassProgram() {
  glDeleteVertexArrays(1, &array_);
  glDeleteProgram(name_);
}

void PassProgram::draw(const Texture& target, const std::vector<const Texture*>& inputs) const {
  glUseProgram(name_);
  glBindVertexArray(array_);
  target.bindAsTarget();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + i));
    glBindTexture(GL_TEXTURE_2D, inputs[i]->name());
  }
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace race
