// SPDX-License-Identifier: MIT
//
// Uniforms of a program that remember what they hold, so that a call sets only those that change.
// Their program must be bound when they are set. A location of -1 is skipped, as in GL.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <epoxy/gl.h>

#include "sk/program.hpp"

namespace sk::gl {

using Int4 = std::array<std::int32_t, 4>;

/// An `int` or `ivec4`.
class IntUniform {
 public:
  IntUniform() = default;
  IntUniform(GLint location, bool isVector) : location_(location), isVector_(isVector) {}

  void set(const Int4& value) {
    if (location_ >= 0 && !(isKnown_ && value_ == value)) {
      send(value);
    }
  }
  void set(std::int32_t value) { set(Int4{value, 0, 0, 0}); }

 private:
  void send(const Int4& value);

  GLint location_ = -1;
  bool isVector_ = true;
  bool isKnown_ = false;
  Int4 value_{};
};

/// One field of the value of a uniform parameter.
class FieldUniform {
 public:
  FieldUniform(GLint location, const program::Field& field) : location_(location), field_(&field) {}

  /// `value`: of the whole parameter, laid out as its Element says.
  void set(const void* value);

 private:
  GLint location_;
  const program::Field* field_;
  bool isKnown_ = false;
  std::array<std::byte, 16> last_{};
};

}  // namespace sk::gl
