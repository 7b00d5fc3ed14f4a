// SPDX-License-Identifier: MIT
#include "support/gl_objects.hpp"

#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace examples {
namespace {

GLuint compiled(GLenum stage, std::string_view body) {
  const std::string text = fmt::format("#version 330 core\n{}", body);
  const char* source = text.c_str();
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (good) return shader;
  std::string log(4096, '\0');
  GLsizei length = 0;
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
  glDeleteShader(shader);
  throw std::runtime_error(fmt::format("the driver does not compile a shader for drawing: {}",
                                       log.substr(0, std::size_t(length))));
}

void setFilter(GLenum filter, GLenum wrap) {
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap));
}

}  // namespace

GlBuffer makeBuffer(std::int64_t bytes, const void* data, GLenum usage) {
  GLuint name = 0;
  glGenBuffers(1, &name);
  glBindBuffer(GL_ARRAY_BUFFER, name);
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), data, usage);
  return GlBuffer(name);
}

GlVertexArray makeVertexArray() {
  GLuint name = 0;
  glGenVertexArrays(1, &name);
  return GlVertexArray(name);
}

GlTexture makeTexture(GLenum internalFormat, GLenum format, GLenum type, int width, int height) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(internalFormat), width, height, 0, format, type, nullptr);
  setFilter(GL_LINEAR, GL_CLAMP_TO_EDGE);
  return GlTexture(name);
}

GlTexture makeDepthTexture(int width, int height) {
  GlTexture texture = makeTexture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, width, height);
  setFilter(GL_LINEAR, GL_CLAMP_TO_BORDER);
  constexpr float far[4] = {1, 1, 1, 1};
  glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, far);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  return texture;
}

GlTexture makeBufferTexture(GLenum internalFormat, GLuint buffer) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_BUFFER, name);
  glTexBuffer(GL_TEXTURE_BUFFER, internalFormat, buffer);
  return GlTexture(name);
}

GlFramebuffer makeFramebuffer(GLuint colour, GLuint depth) {
  GLuint name = 0;
  glGenFramebuffers(1, &name);
  GlFramebuffer framebuffer(name);
  glBindFramebuffer(GL_FRAMEBUFFER, name);
  if (colour != 0) {
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, colour, 0);
  } else {
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
  }
  if (depth != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("the driver cannot draw to a picture of this size; take a smaller one");
  }
  return framebuffer;
}

GlProgram makeProgram(std::string_view vertex, std::string_view fragment) {
  GlProgram program(glCreateProgram());
  for (const auto& [stage, body] :
       {std::pair{GL_VERTEX_SHADER, vertex}, std::pair{GL_FRAGMENT_SHADER, fragment}}) {
    const GLuint shader = compiled(static_cast<GLenum>(stage), body);
    glAttachShader(program.get(), shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program.get());
  GLint good = 0;
  glGetProgramiv(program.get(), GL_LINK_STATUS, &good);
  if (!good) throw std::runtime_error("the driver does not link a program for drawing");
  return program;
}

FullView::FullView(std::string_view fragment)
    : program_(makeProgram(R"(
  out vec2 at;
  void main() {
    at = vec2(gl_VertexID % 2, gl_VertexID / 2);
    gl_Position = vec4(2.0 * at - 1.0, 0.0, 1.0);
  })",
                           fragment)) {}

void FullView::bind(const char* name, int unit, GLuint texture) const {
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture);
  glUniform1i((*this)[name], unit);
}

void FullView::draw() const {
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glBindVertexArray(0);
  glUseProgram(0);
}

}  // namespace examples
