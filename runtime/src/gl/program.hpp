// SPDX-License-Identifier: MIT
//
// A linked program of a vertex and a fragment shader, from their sources or in the driver's own form.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "gl/object_name.hpp"

namespace sk::gl {

inline void deleteProgram(GLuint name) { glDeleteProgram(name); }
inline void deleteShader(GLuint name) { glDeleteShader(name); }

/// A program as a driver has made it. Another driver, or another version, may refuse it.
struct ProgramBinary {
  GLenum format = 0;
  std::vector<std::byte> bytes;   ///< none where the driver gives none
};

class Program {
 public:
  Program() = default;
  /// Compiles and links. Where the driver refuses, the result is empty and `log` has its words.
  static Program build(const std::string& vertexSource, const std::string& fragmentSource, std::string& log);
  /// Empty where the driver refuses. The format is one that it knows.
  static Program load(GLenum format, std::span<const std::byte> bytes);

  /// Of a program that was started to be kept.
  ProgramBinary binary() const;

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// -1 where the program does not use the uniform.
  GLint location(const std::string& uniform) const { return glGetUniformLocation(name(), uniform.c_str()); }
  /// Gives a sampler its texture unit; the program must be bound.
  void setSampler(const std::string& sampler, int unit) const { glUniform1i(location(sampler), unit); }
  void forget() noexcept { name_.forget(); }

 private:
  friend class PendingProgram;
  explicit Program(GLuint name) : name_(name) {}

  ObjectName<deleteProgram> name_;
};

/// A program that the driver has been told to compile. Drivers that compile on threads of their own
/// (KHR_parallel_shader_compile, and others without a word) work at several at a time.
class PendingProgram {
 public:
  PendingProgram() = default;
  /// Waits for nothing. `isKept`: somebody will ask for the binary.
  PendingProgram(const std::string& vertexSource, const std::string& fragmentSource, bool isKept);

  /// Waits. Where the driver refuses, the result is empty and `log` has its words.
  Program finish(std::string& log);
  void forget() noexcept;

 private:
  using Shader = ObjectName<deleteShader>;

  Program program_;
  Shader vertex_, fragment_;
};

}  // namespace sk::gl
