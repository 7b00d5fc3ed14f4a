// SPDX-License-Identifier: MIT
//
// Sending uniforms whose values have changed.
#include "gl/uniform.hpp"

#include <cstring>

namespace sk::gl {

namespace {

using program::Field;
using program::Scalar;

std::size_t bytesOf(const Field& field) {
  return (field.scalar == Scalar::Bool ? 1u : 4u) * std::size_t{field.width};
}

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

template <class T>
std::array<T, 4> componentsOf(const std::byte* bytes, int width) {
  std::array<T, 4> components{};
  std::memcpy(components.data(), bytes, sizeof(T) * static_cast<std::size_t>(width));
  return components;
}

void sendField(GLint location, const Field& field, const std::byte* bytes) {
  switch (field.scalar) {
    case Scalar::Bool: {
      std::array<GLint, 4> components{};
      for (std::size_t c = 0; c < field.width; ++c) {
        components[c] = bytes[c] != std::byte{0};
      }
      sendInts(location, field.width, components.data());
      return;
    }
    case Scalar::Int: sendInts(location, field.width, componentsOf<GLint>(bytes, field.width).data()); return;
    case Scalar::Uint:
      sendUints(location, field.width, componentsOf<GLuint>(bytes, field.width).data());
      return;
    case Scalar::Float:
      sendFloats(location, field.width, componentsOf<GLfloat>(bytes, field.width).data());
      return;
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

void FieldUniform::set(const void* value) {
  const std::byte* bytes = static_cast<const std::byte*>(value) + field_->offset;
  const std::size_t size = bytesOf(*field_);
  if (location_ < 0 || (isKnown_ && std::memcmp(last_.data(), bytes, size) == 0)) {
    return;
  }
  std::memcpy(last_.data(), bytes, size);
  isKnown_ = true;
  sendField(location_, *field_, last_.data());
}

}  // namespace sk::gl
