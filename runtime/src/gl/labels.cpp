// SPDX-License-Identifier: MIT
#include "gl/labels.hpp"

#include <algorithm>

namespace sk::gl {

namespace {

/// The length that every implementation supports (GL_MAX_LABEL_LENGTH is at least 256 with the terminator),
/// also for groups.
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
