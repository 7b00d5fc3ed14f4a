// SPDX-License-Identifier: MIT
//
// A linked program: of a vertex and a fragment shader, or of a compute shader.
#pragma once

#include <array>
#include <initializer_list>
#include <string>

#include "gl/object_name.hpp"

namespace sk::gl {

inline void deleteProgram(GLuint name) { glDeleteProgram(name); }

class Program {
 public:
  Program() = default;
  /// Compiles and links. Where the driver refuses, the result is empty and `log` has its words.
  static Program build(const std::string& vertexSource, const std::string& fragmentSource, std::string& log);

  /// The same of a compute shader.
  static Program buildCompute(const std::string& source, std::string& log);

  GLuint name() const { return name_.get(); }
  explicit operator bool() const { return static_cast<bool>(name_); }
  /// -1 where the program does not use the uniform.
  GLint location(const std::string& uniform) const { return glGetUniformLocation(name(), uniform.c_str()); }
  /// Gives a sampler its texture unit; the program must be bound.
  void setSampler(const std::string& sampler, int unit) const { glUniform1i(location(sampler), unit); }
  /// Of a compute program: invocations in x and y.
  std::array<GLint, 3> workGroup() const;
  void forget() noexcept { name_.forget(); }

 private:
  explicit Program(GLuint name) : name_(name) {}
  static Program link(std::initializer_list<GLuint> shaders, std::string& log);

  ObjectName<deleteProgram> name_;
};

}  // namespace sk::gl
