// SPDX-License-Identifier: MIT
#include "hand_written.hpp"

#include <array>
#include <stdexcept>

#include <fmt/format.h>

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

const char* const vertexText = R"(#version 330 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

/// Every display to try: without a window, then each device.
std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> found;
  const char* clientExtensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const std::string extensions = clientExtensions == nullptr ? "" : clientExtensions;
  const auto has = [&](const char* name) { return extensions.find(name) != std::string::npos; };
  if (has("EGL_MESA_platform_surfaceless")) {
    found.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  if (has("EGL_EXT_platform_device")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
    for (EGLint i = 0; i < count; ++i) {
      found.push_back(
          eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    }
  }
  found.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  return found;
}

GLuint compiled(GLenum kind, const char* text) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint done = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
  if (done == GL_FALSE) {
    std::array<char, 4096> log{};
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(fmt::format("a hand-written shader does not compile: {}", log.data()));
  }
  return shader;
}

GLuint linked(const char* fragmentText) {
  const GLuint vertex = compiled(GL_VERTEX_SHADER, vertexText);
  const GLuint fragment = compiled(GL_FRAGMENT_SHADER, fragmentText);
  const GLuint program = glCreateProgram();
  for (const GLuint shader : {vertex, fragment}) {
    glAttachShader(program, shader);
    glDeleteShader(shader);
  }
  glLinkProgram(program);
  GLint done = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &done);
  if (done == GL_FALSE) throw std::runtime_error("a hand-written program does not link");
  return program;
}

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

PlainContext::PlainContext(const std::string& renderer) {
  for (const EGLDisplay display : displays()) {
    if (display != EGL_NO_DISPLAY && tryDisplay(display, renderer)) return;
  }
  throw std::runtime_error(fmt::format("EGL has no display with renderer '{}' and GL 3.3", renderer));
}

bool PlainContext::tryDisplay(EGLDisplay display, const std::string& renderer) {
  if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE || eglBindAPI(EGL_OPENGL_API) == EGL_FALSE)
    return false;
  const std::array<EGLint, 5> wanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                                        EGL_PBUFFER_BIT, EGL_NONE};
  EGLConfig config = EGL_NO_CONFIG_KHR;
  EGLint count = 0;
  eglChooseConfig(display, wanted.data(), &config, 1, &count);
  const std::array<EGLint, 7> version = {EGL_CONTEXT_MAJOR_VERSION,
                                         3,
                                         EGL_CONTEXT_MINOR_VERSION,
                                         3,
                                         EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                         EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                         EGL_NONE};
  context_ =
      eglCreateContext(display, count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version.data());
  if (context_ == EGL_NO_CONTEXT) return false;
  display_ = display;
  {
    const Current current(*this);
    const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (name != nullptr && renderer == name) return true;
  }
  eglDestroyContext(display, context_);
  context_ = EGL_NO_CONTEXT;
  return false;
}

PlainContext::~PlainContext() {
  // The display stays: the runtime may have it too.
  if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
}

PlainContext::Current::Current(const PlainContext& context) : display_(context.display_) {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_);
}

PlainContext::Current::~Current() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

PlainPass::PlainPass(const char* fragmentText, int width, int height,
                     const std::vector<std::vector<float>>& inputs)
    : program_(linked(fragmentText)), width_(width), height_(height) {
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
