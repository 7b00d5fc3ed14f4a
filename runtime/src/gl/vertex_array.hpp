// SPDX-License-Identifier: MIT
//
// The vertex array without attributes, which every draw requires and none reads.
#pragma once

#include "gl/object_name.hpp"

namespace sk::gl {

inline void deleteVertexArray(BoundState&, GLuint name) { glDeleteVertexArrays(1, &name); }

class VertexArray {
 public:
  VertexArray() = default;
  explicit VertexArray(Deletions& deletions)
      : name_(deletions, [] { return generated(glGenVertexArrays); }) {}

  GLuint name() const { return name_.get(); }

 private:
  ObjectName<deleteVertexArray> name_;
};

}  // namespace sk::gl
