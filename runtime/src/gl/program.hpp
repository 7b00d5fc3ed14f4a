// SPDX-License-Identifier: MIT
//
// A linked program of a vertex and a fragment shader, or of a compute shader, from their sources or in the driver's own form.
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

/// A program as a driver has made it. Another driver, or another version, may refuse it.
struct ProgramBinary {
  GLenum format = 0;
  std::vector<std::byte> bytes;  ///< none where the driver gives none
};

/// What a program is compiled of.
struct ProgramSources {
  std::string vertex;  ///< empty: it is a compute program
  std::string main;  ///< the fragment shader, or the compute shader

  bool isCompute() const { return vertex.empty(); }
};

class Program {
 public:
  Program() = default;
  /// Compiles and links. Where the driver refuses, the result is empty and `log` has its words.
  static Program build(BoundState& bound, const ProgramSources& sources, std::string& log);
  /// Empty where the driver refuses. The format is one that it knows.
  static Program load(BoundState& bound, GLenum format, std::span<const std::byte> bytes);

  /// Of a program that was started to be kept.
  ProgramBinary binary() const;

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// -1 where the program does not use the uniform.
  GLint location(const std::string& uniform) const { return glGetUniformLocation(name(), uniform.c_str()); }
  /// Gives a sampler its texture unit; the program must be bound.
  void setSampler(const std::string& sampler, int unit) const { glUniform1i(location(sampler), unit); }
  /// Of a compute program: invocations in x and y.
  std::array<GLint, 3> workGroup() const;

 private:
  friend class PendingProgram;
  explicit Program(BoundState& bound);

  ObjectName<deleteProgram> name_;
};

/// A program that the driver has been told to compile. Drivers that compile on threads of their own
/// (KHR_parallel_shader_compile, and others without a word) work at several at a time.
class PendingProgram {
 public:
  PendingProgram() = default;
  /// Waits for nothing. `isKept`: somebody will ask for the binary.
  PendingProgram(BoundState& bound, const ProgramSources& sources, bool isKept);

  /// Waits. Where the driver refuses, the result is empty and `log` has its words.
  Program finish(std::string& log);

 private:
  using Shader = ObjectName<deleteShader>;

  void addShader(GLuint shader, const std::string& source) const;

  Program program_;
  Shader vertex_;  ///< none of a compute program
  Shader main_;
};

}  // namespace sk::gl
