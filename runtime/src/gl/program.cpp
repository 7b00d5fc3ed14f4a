// SPDX-License-Identifier: MIT
//
// Compiling and linking.
#include "gl/program.hpp"

namespace sk::gl {

namespace {

void deleteShader(GLuint name) { glDeleteShader(name); }
using Shader = ObjectName<deleteShader>;

/// Adds the driver's log of a shader or program to `log`.
template <class GetParameter, class GetLog>
void appendLog(GLuint object, GetParameter getParameter, GetLog getLog, std::string& log) {
  GLint length = 0;
  getParameter(object, GL_INFO_LOG_LENGTH, &length);
  if (length > 1) {
    std::string text(static_cast<std::size_t>(length), '\0');
    getLog(object, length, &length, text.data());
    text.resize(static_cast<std::size_t>(length));
    log += text;
  }
}

Shader compile(GLenum stage, const std::string& source, std::string& log) {
  Shader shader(glCreateShader(stage));
  const char* text = source.data();
  const auto length = static_cast<GLint>(source.size());
  glShaderSource(shader.get(), 1, &text, &length);
  glCompileShader(shader.get());
  GLint isCompiled = GL_FALSE;
  glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &isCompiled);
  if (isCompiled == GL_FALSE) {
    appendLog(shader.get(), glGetShaderiv, glGetShaderInfoLog, log);
    return {};
  }
  return shader;
}

}  // namespace

Program Program::build(const std::string& vertexSource, const std::string& fragmentSource, std::string& log) {
  const Shader vertex = compile(GL_VERTEX_SHADER, vertexSource, log);
  const Shader fragment = compile(GL_FRAGMENT_SHADER, fragmentSource, log);
  if (!vertex || !fragment) {
    return {};
  }
  return link({vertex.get(), fragment.get()}, log);
}

Program Program::buildCompute(const std::string& source, std::string& log) {
  const Shader shader = compile(GL_COMPUTE_SHADER, source, log);
  return shader ? link({shader.get()}, log) : Program();
}

Program Program::link(std::initializer_list<GLuint> shaders, std::string& log) {
  Program program(glCreateProgram());
  for (const GLuint shader : shaders) glAttachShader(program.name(), shader);
  glLinkProgram(program.name());
  for (const GLuint shader : shaders) glDetachShader(program.name(), shader);
  GLint isLinked = GL_FALSE;
  glGetProgramiv(program.name(), GL_LINK_STATUS, &isLinked);
  if (isLinked == GL_FALSE) {
    appendLog(program.name(), glGetProgramiv, glGetProgramInfoLog, log);
    return {};
  }
  return program;
}

std::array<GLint, 3> Program::workGroup() const {
  std::array<GLint, 3> size{1, 1, 1};
  glGetProgramiv(name(), GL_COMPUTE_WORK_GROUP_SIZE, size.data());
  return size;
}

}  // namespace sk::gl
