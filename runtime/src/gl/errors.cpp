// SPDX-License-Identifier: MIT
//
// Reads GL's error flags.
#include "gl/errors.hpp"

namespace sk::gl {

// Terminates even on a lost context, which reports errors forever.
GLenum Errors::takeNew() {
  const GLenum first = glGetError();
  bool isLost = first == GL_CONTEXT_LOST, isFull = first == GL_OUT_OF_MEMORY;
  GLenum next = first;
  for (int flag = 0; flag < 16 && next != GL_NO_ERROR; ++flag) {
    next = glGetError();
    isLost = isLost || next == GL_CONTEXT_LOST;
    isFull = isFull || next == GL_OUT_OF_MEMORY;
  }
  isLost_ = isLost_ || isLost;
  return isLost ? GL_CONTEXT_LOST : isFull ? GL_OUT_OF_MEMORY : first;
}

const char* errorName(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY";
    case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST";
    case GL_NO_ERROR: return "GL_NO_ERROR";
    default: return "an unknown GL error";
  }
}

}  // namespace sk::gl
