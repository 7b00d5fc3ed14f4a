// SPDX-License-Identifier: MIT
#include "plain_context.hpp"

#include <array>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

namespace bench {
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

GLuint linkedProgram(const char* fragmentText) {
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

}  // namespace bench
