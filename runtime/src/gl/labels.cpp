// SPDX-License-Identifier: MIT
#include "gl/labels.hpp"

#include <algorithm>

namespace sk::gl {

namespace {

/// What every implementation takes (GL_MAX_LABEL_LENGTH is 256 at least, with the zero at the end); a group's message too.
constexpr std::size_t longest = 255;

GLsizei lengthOf(std::string_view label) { return static_cast<GLsizei>(std::min(label.size(), longest)); }

}  // namespace

void Labels::set(GLenum kind, GLuint name, std::string_view label) {
  if (name != 0) glObjectLabel(kind, name, lengthOf(label), label.data());
}

void LabelGroup::push(std::string_view label) {
  glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, lengthOf(label), label.data());
}

}  // namespace sk::gl
