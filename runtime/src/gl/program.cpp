// SPDX-License-Identifier: MIT
//
// Compiles and links. Queries the driver only at the end, because every query waits for the compiler.
// Sets uniforms whose values have changed.
#include "gl/program.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "gl/bound_state.hpp"
#include "gl/format.hpp"
#include "sk/narrow.hpp"

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

namespace {

using program::Field;
using program::Scalar;

using Floats = std::array<GLfloat, 16>;
using Ints = std::array<GLint, 4>;

void sendInts(GLint location, int width, const GLint* v) {
  switch (width) {
    case 1: glUniform1iv(location, 1, v); return;
    case 2: glUniform2iv(location, 1, v); return;
    case 3: glUniform3iv(location, 1, v); return;
    default: glUniform4iv(location, 1, v); return;
  }
}

void sendUints(GLint location, int width, const GLuint* v) {
  switch (width) {
    case 1: glUniform1uiv(location, 1, v); return;
    case 2: glUniform2uiv(location, 1, v); return;
    case 3: glUniform3uiv(location, 1, v); return;
    default: glUniform4uiv(location, 1, v); return;
  }
}

void sendFloats(GLint location, int width, const GLfloat* v) {
  switch (width) {
    case 1: glUniform1fv(location, 1, v); return;
    case 2: glUniform2fv(location, 1, v); return;
    case 3: glUniform3fv(location, 1, v); return;
    default: glUniform4fv(location, 1, v); return;
  }
}

void sendMatrix(GLint location, int width, const GLfloat* v) {
  switch (width) {
    case 2: glUniformMatrix2fv(location, 1, GL_FALSE, v); return;
    case 3: glUniformMatrix3fv(location, 1, GL_FALSE, v); return;
    default: glUniformMatrix4fv(location, 1, GL_FALSE, v); return;
  }
}

/// Converts `count` components of type T in host memory to the components of an array.
template <class T, class Components>
Components componentsOf(const std::byte* bytes, std::size_t count) {
  Components components{};
  for (std::size_t c = 0; c < count; ++c) {
    T value;
    std::memcpy(&value, bytes + c * sizeof(T), sizeof(T));
    components[c] = static_cast<typename Components::value_type>(value);
  }
  return components;
}

template <class T>
void sendAsInts(GLint location, const Field& field, const std::byte* bytes) {
  sendInts(location, field.width, componentsOf<T, Ints>(bytes, field.width).data());
}

template <class T>
void sendAsFloats(GLint location, const Field& field, const std::byte* bytes) {
  sendFloats(location, field.width, componentsOf<T, Floats>(bytes, field.width).data());
}

void sendField(GLint location, const Field& field, const std::byte* bytes) {
  switch (field.scalar) {
    case Scalar::Bool: {
      Ints components{};
      for (std::size_t c = 0; c < field.width; ++c) {
        components[c] = bytes[c] != std::byte{0};
      }
      return sendInts(location, field.width, components.data());
    }
    case Scalar::Uint:
      return sendUints(location, field.width,
                       componentsOf<GLuint, std::array<GLuint, 4>>(bytes, field.width).data());
    case Scalar::Int: return sendAsInts<GLint>(location, field, bytes);
    case Scalar::Char: return sendAsInts<std::int8_t>(location, field, bytes);
    case Scalar::Uchar: return sendAsInts<std::uint8_t>(location, field, bytes);
    case Scalar::Short: return sendAsInts<std::int16_t>(location, field, bytes);
    case Scalar::Ushort: return sendAsInts<std::uint16_t>(location, field, bytes);
    case Scalar::Float: return sendAsFloats<GLfloat>(location, field, bytes);
    case Scalar::Half: return sendAsFloats<half>(location, field, bytes);
    case Scalar::Unorm8: return sendAsFloats<unorm8>(location, field, bytes);
    case Scalar::Snorm8: return sendAsFloats<snorm8>(location, field, bytes);
    case Scalar::Unorm16: return sendAsFloats<unorm16>(location, field, bytes);
    case Scalar::Snorm16: return sendAsFloats<snorm16>(location, field, bytes);
    case Scalar::Double:
    case Scalar::Long:
    case Scalar::Ulong: break;  // WideUniform sets them
  }
}

}  // namespace

void IntUniform::send(const Int4& value) {
  value_ = value;
  isKnown_ = true;
  if (isVector_) {
    glUniform4iv(location_, 1, value_.data());
  } else {
    glUniform1i(location_, value_[0]);
  }
}

FieldUniform::FieldUniform(GLint location, std::span<const program::Field> parts)
    : location_(location), field_(&parts.front()), parts_(static_cast<int>(parts.size())) {
  for (const Field& part : parts) {
    size_ += hostBytes(part);
  }
}

void FieldUniform::set(BoundState& bound, const void* value) {
  if (location_ < 0) return;
  const std::byte* const bytes = static_cast<const std::byte*>(value) + field_->offset;
  bound.note(*this, std::span(bytes, size_));
  setBytes(bytes);
}

void FieldUniform::setBytes(const std::byte* bytes) {
  if (isKnown_ && std::memcmp(last_.data(), bytes, size_) == 0) return;
  std::memcpy(last_.data(), bytes, size_);
  isKnown_ = true;
  if (parts_ == 1) {
    sendField(location_, *field_, last_.data());
  } else {
    sendMatrix(location_, parts_,
               componentsOf<GLfloat, Floats>(last_.data(), size_ / sizeof(GLfloat)).data());
  }
}

void WideUniform::set(BoundState& bound, const void* value) {
  double whole = 0;
  std::memcpy(&whole, static_cast<const std::byte*>(value) + offset_, sizeof whole);
  bound.note(*this, whole);
  setValue(whole);
}

void WideUniform::setValue(double whole) {
  if (isKnown_ && std::memcmp(&last_, &whole, sizeof whole) == 0) {
    return;
  }
  last_ = whole;
  isKnown_ = true;
  if (bits_ >= 0) {
    const auto bits = std::bit_cast<std::uint64_t>(whole);
    glUniform2ui(bits_, static_cast<GLuint>(bits), static_cast<GLuint>(bits >> 32));
    return;
  }
  const auto head = static_cast<float>(whole);
  const float tail = std::isfinite(head) ? static_cast<float>(whole - head) : 0;
  glUniform1f(head_, head);
  glUniform1f(tail_, tail);
}

}  // namespace sk::gl
