// SPDX-License-Identifier: MIT
//
// Compiles and links. Queries the driver only at the end, because every query waits for the compiler.
#include "gl/program.hpp"

#include "gl/bound_state.hpp"

namespace sk::gl {

namespace {

/// Appends the driver's log of a shader or program to `log`.
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

ObjectName<deleteShader> newShader(BoundState& bound, GLenum stage) {
  return {bound.deletions, [&] { return glCreateShader(stage); }};
}

/// Appends the log of a shader that fails to compile.
bool isCompiled(GLuint shader, std::string& log) {
  GLint status = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &status);
  if (status == GL_FALSE) {
    appendLog(shader, glGetShaderiv, glGetShaderInfoLog, log);
  }
  return status != GL_FALSE;
}

bool isLinked(GLuint program) {
  GLint status = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &status);
  return status != GL_FALSE;
}

}  // namespace

void deleteProgram(BoundState& bound, GLuint name) {
  glDeleteProgram(name);
  bound.forgetProgram(name);
}
void deleteShader(BoundState&, GLuint name) { glDeleteShader(name); }

Program::Program(BoundState& bound) : name_(bound.deletions, [] { return glCreateProgram(); }) {}

Program Program::build(BoundState& bound, const ProgramSources& sources, std::string& log) {
  return PendingProgram(bound, sources, false).finish(log);
}

Program Program::load(BoundState& bound, GLenum format, std::span<const std::byte> bytes) {
  bound.errors.setAside();
  Program program(bound);
  glProgramBinary(program.name(), format, bytes.data(), static_cast<GLsizei>(bytes.size()));
  if (isLinked(program.name())) return program;
  static_cast<void>(bound.errors.takeNew());  // it is compiled from source instead
  return {};
}

ProgramBinary Program::binary() const {
  GLint length = 0;
  glGetProgramiv(name(), GL_PROGRAM_BINARY_LENGTH, &length);
  ProgramBinary binary;
  binary.bytes.resize(static_cast<std::size_t>(length));
  if (length > 0) {
    glGetProgramBinary(name(), length, &length, &binary.format, binary.bytes.data());
    binary.bytes.resize(static_cast<std::size_t>(length));
  }
  return binary;
}

PendingProgram::PendingProgram(BoundState& bound, const ProgramSources& sources, bool isRetrievable) {
  bound.errors.setAside();
  program_ = Program(bound);
  main_ = newShader(bound, sources.isCompute() ? GL_COMPUTE_SHADER : GL_FRAGMENT_SHADER);
  if (!sources.isCompute()) vertex_ = newShader(bound, GL_VERTEX_SHADER);
  if (!program_ || !main_ || (!vertex_ && !sources.isCompute())) {
    static_cast<void>(bound.errors.takeNew());  // finish() reports it
    program_ = {};
    return;
  }
  if (vertex_) addShader(vertex_.get(), sources.vertex);
  addShader(main_.get(), sources.main);
  if (isRetrievable) {
    glProgramParameteri(program_.name(), GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
  }
  glLinkProgram(program_.name());
}

void PendingProgram::addShader(GLuint shader, const std::string& source) const {
  const char* text = source.data();
  const auto length = static_cast<GLint>(source.size());
  glShaderSource(shader, 1, &text, &length);
  glCompileShader(shader);
  glAttachShader(program_.name(), shader);
}

Program PendingProgram::finish(std::string& log) {
  if (!program_) {
    log += "it makes no shader or program any more";
    return {};
  }
  if (!isLinked(program_.name())) {
    if ((!vertex_ || isCompiled(vertex_.get(), log)) && isCompiled(main_.get(), log)) {
      appendLog(program_.name(), glGetProgramiv, glGetProgramInfoLog, log);
    }
    return {};
  }
  if (vertex_) glDetachShader(program_.name(), vertex_.get());
  glDetachShader(program_.name(), main_.get());
  vertex_ = {};
  main_ = {};
  return std::move(program_);
}

std::array<GLint, 3> Program::workGroup() const {
  std::array<GLint, 3> size{1, 1, 1};
  glGetProgramiv(name(), GL_COMPUTE_WORK_GROUP_SIZE, size.data());
  return size;
}

}  // namespace sk::gl
