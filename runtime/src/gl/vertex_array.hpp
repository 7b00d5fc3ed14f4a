// SPDX-License-Identifier: MIT
//
// The vertex array without attributes that every draw needs and none reads.
#pragma once

#include "gl/object_name.hpp"

namespace sk::gl {

inline void deleteVertexArray(GLuint name) { glDeleteVertexArrays(1, &name); }

class VertexArray {
 public:
  VertexArray() = default;
  static VertexArray create() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return VertexArray(name);
  }

  GLuint name() const { return name_.get(); }
  void forget() noexcept { name_.forget(); }

 private:
  explicit VertexArray(GLuint name) : name_(name) {}

  ObjectName<deleteVertexArray> name_;
};

}  // namespace sk::gl
