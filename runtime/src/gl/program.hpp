// SPDX-License-Identifier: MIT
//
// A linked program: a vertex and a fragment shader, or a compute shader, from source or from a driver's
// binary.
//
// Uniforms that remember their values, so that a call sets only those that change. Their program must be
// bound when they are set. As in GL, a location of -1 is ignored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "gl/bound_state.hpp"
#include "gl/object_name.hpp"
#include "sk/program.hpp"

namespace sk::gl {

void deleteProgram(BoundState& bound, GLuint name);
void deleteShader(BoundState& bound, GLuint name);

/// A driver's program binary. Another driver, or another version, may reject it.
struct ProgramBinary {
  GLenum format = 0;
  std::vector<std::byte> bytes;  ///< empty if the driver returns none
};

/// The sources of a program.
struct ProgramSources {
  std::string vertex;  ///< empty: it is a compute program
  std::string main;  ///< the fragment shader, or the compute shader

  bool isCompute() const { return vertex.empty(); }
};

class Program {
 public:
  Program() = default;
  /// Compiles and links. If the driver rejects the program, the result is empty and `log` has its messages.
  static Program build(BoundState& bound, const ProgramSources& sources, std::string& log);
  /// Empty if the driver rejects the binary. The driver must know the format.
  static Program load(BoundState& bound, GLenum format, std::span<const std::byte> bytes);

  /// Requires a program that was started with `isRetrievable`.
  ProgramBinary binary() const;

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// -1 if the program does not use the uniform.
  GLint location(const std::string& uniform) const { return glGetUniformLocation(name(), uniform.c_str()); }
  /// Assigns a texture unit to a sampler; the program must be bound.
  void setSampler(const std::string& sampler, int unit) const { glUniform1i(location(sampler), unit); }
  /// The size of a compute program's work groups in x and y.
  std::array<GLint, 3> workGroup() const;

 private:
  friend class PendingProgram;
  explicit Program(BoundState& bound);

  ObjectName<deleteProgram> name_;
};

/// A program that the driver is compiling. Drivers with compiler threads (KHR_parallel_shader_compile, or
/// without any announcement) compile several at a time.
class PendingProgram {
 public:
  PendingProgram() = default;
  /// Returns without waiting. `isRetrievable`: binary() will be called.
  PendingProgram(BoundState& bound, const ProgramSources& sources, bool isRetrievable);

  /// Waits. If the driver rejects the program, the result is empty and `log` has its messages.
  Program finish(std::string& log);

 private:
  using Shader = ObjectName<deleteShader>;

  void addShader(GLuint shader, const std::string& source) const;

  Program program_;
  Shader vertex_;  ///< empty for a compute program
  Shader main_;
};

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
class WideUniform {
 public:
  static WideUniform bits(GLint bits, std::uint32_t offset) { return {bits, -1, -1, offset}; }
  static WideUniform pair(GLint head, GLint tail, std::uint32_t offset) { return {-1, head, tail, offset}; }

  /// `value` is the whole parameter, with the double at byte `offset`.
  void set(BoundState& bound, const void* value);
  void setValue(double value);

 private:
  WideUniform(GLint bits, GLint head, GLint tail, std::uint32_t offset)
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
  const program::Field* field_;  ///< the first part
  int parts_;
  std::size_t size_ = 0;  ///< bytes in host memory
  bool isKnown_ = false;
  std::array<std::byte, 64> last_{};
};

}  // namespace sk::gl
