// SPDX-License-Identifier: MIT
//
// A linked program: a vertex and a fragment shader, or a compute shader, from source or from a driver's
// binary.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gl/object_name.hpp"

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

}  // namespace sk::gl
