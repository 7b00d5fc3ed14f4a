// SPDX-License-Identifier: MIT
//
// Uniforms that remember their values, so that a call sets only those that change. Their program must be
// bound when they are set. As in GL, a location of -1 is ignored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <epoxy/gl.h>

#include "gl/bound_state.hpp"
#include "sk/program.hpp"

namespace sk::gl {

using Int4 = std::array<std::int32_t, 4>;

/// An `int` or `ivec4`.
class IntUniform {
 public:
  IntUniform() = default;
  IntUniform(GLint location, bool isVector) : location_(location), isVector_(isVector) {}

  void set(BoundState& bound, const Int4& value) {
    if (location_ < 0) return;
    bound.note({.kind = Command::Kind::Ints, .uniform = this, .numbers = value});
    if (!(isKnown_ && value_ == value)) send(value);
  }
  void set(BoundState& bound, std::int32_t value) { set(bound, Int4{value, 0, 0, 0}); }

 private:
  void send(const Int4& value);

  GLint location_ = -1;
  bool isVector_ = true;
  bool isKnown_ = false;
  Int4 value_{};
};

/// A double in the value of a uniform parameter, sent as its bits or as a pair of floats.
class DoubleUniform {
 public:
  static DoubleUniform bits(GLint bits, std::uint32_t offset) { return {bits, -1, -1, offset}; }
  static DoubleUniform pair(GLint head, GLint tail, std::uint32_t offset) { return {-1, head, tail, offset}; }

  /// `value` is the whole parameter, with the double at byte `offset`.
  void set(BoundState& bound, const void* value);
  void setValue(double value);

 private:
  DoubleUniform(GLint bits, GLint head, GLint tail, std::uint32_t offset)
      : bits_(bits), head_(head), tail_(tail), offset_(offset) {}

  GLint bits_, head_, tail_;
  std::uint32_t offset_;
  bool isKnown_ = false;
  double last_ = 0;
};

/// A scalar, vector or matrix in the value of a uniform parameter, except doubles.
class FieldUniform {
 public:
  /// `parts` is a single field, or a matrix's rows in order.
  FieldUniform(GLint location, std::span<const program::Field> parts);

  /// `value` is the whole parameter, laid out as its Element says.
  void set(BoundState& bound, const void* value);
  /// `bytes` is its own part of the parameter.
  void setBytes(const std::byte* bytes);

 private:
  GLint location_;
  const program::Field* field_;   ///< the first part
  int parts_;
  std::size_t size_ = 0;  ///< bytes in host memory
  bool isKnown_ = false;
  std::array<std::byte, 64> last_{};
};

}  // namespace sk::gl
