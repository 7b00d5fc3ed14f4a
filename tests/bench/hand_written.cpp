// SPDX-License-Identifier: MIT
#include "hand_written.hpp"

namespace bench {

const char* const saxpyText = R"(#version 330 core
uniform sampler2D x;
uniform sampler2D y;
uniform float a;
layout(location = 0) out float r;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  r = a * texelFetch(x, p, 0).r + texelFetch(y, p, 0).r;
}
)";

const char* const binomialText = R"(#version 330 core
uniform sampler2D x;
layout(location = 0) out float r;

float at(ivec2 p) {
  return texelFetch(x, clamp(p, ivec2(0), textureSize(x, 0) - 1), 0).r;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  float corners = at(p + ivec2(-1, -1)) + at(p + ivec2(1, -1)) + at(p + ivec2(-1, 1)) + at(p + ivec2(1, 1));
  float sides = at(p + ivec2(0, -1)) + at(p + ivec2(-1, 0)) + at(p + ivec2(1, 0)) + at(p + ivec2(0, 1));
  r = (corners + 2.0 * sides + 4.0 * at(p)) / 16.0;
}
)";

const char* const saxpySampledText = R"(#version 330 core
uniform sampler2D x;
uniform sampler2D y;
uniform float a;
layout(location = 0) out float r;

void main() {
  vec2 p = gl_FragCoord.xy / vec2(textureSize(x, 0));
  r = a * textureLod(x, p, 0.0).r + textureLod(y, p, 0.0).r;
}
)";

const char* const binomialSampledText = R"(#version 330 core
uniform sampler2D x;
layout(location = 0) out float r;

#define AT(dx, dy) textureLodOffset(x, p, 0.0, ivec2(dx, dy)).r

void main() {
  vec2 p = gl_FragCoord.xy / vec2(textureSize(x, 0));
  float corners = AT(-1, -1) + AT(1, -1) + AT(-1, 1) + AT(1, 1);
  float sides = AT(0, -1) + AT(-1, 0) + AT(1, 0) + AT(0, 1);
  r = (corners + 2.0 * sides + 4.0 * AT(0, 0)) / 16.0;
}
)";

namespace {

GLuint floatTexture(int width, int height, const float* texels) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_R32F, width, height, 0, GL_RED, GL_FLOAT, texels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

PlainPass::PlainPass(const char* fragmentText, int width, int height,
                     const std::vector<std::vector<float>>& inputs)
    : program_(linkedProgram(fragmentText)), width_(width), height_(height) {
  for (const std::vector<float>& input : inputs)
    textures_.push_back(floatTexture(width, height, input.data()));
  textures_.push_back(floatTexture(width, height, nullptr));
  glGenVertexArrays(1, &array_);
  glGenFramebuffers(1, &framebuffer_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, textures_.back(), 0);
  glUseProgram(program_);
  glUniform1i(glGetUniformLocation(program_, "x"), 0);
  glUniform1i(glGetUniformLocation(program_, "y"), 1);
}

PlainPass::~PlainPass() {
  glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  glDeleteFramebuffers(1, &framebuffer_);
  glDeleteVertexArrays(1, &array_);
  glDeleteProgram(program_);
}

void PlainPass::setFloat(const char* uniform, float value) const {
  glUseProgram(program_);
  glUniform1f(glGetUniformLocation(program_, uniform), value);
}

void PlainPass::draw() const {
  glUseProgram(program_);
  glBindVertexArray(array_);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glViewport(0, 0, width_, height_);
  for (std::size_t i = 0; i + 1 < textures_.size(); ++i) {
    glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + i));
    glBindTexture(GL_TEXTURE_2D, textures_[i]);
  }
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

std::vector<float> PlainPass::result() const {
  std::vector<float> texels(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
  glReadPixels(0, 0, width_, height_, GL_RED, GL_FLOAT, texels.data());
  return texels;
}

}  // namespace bench
