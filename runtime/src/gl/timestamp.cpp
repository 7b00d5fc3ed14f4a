// SPDX-License-Identifier: MIT
#include "gl/timestamp.hpp"

namespace sk::gl {

bool hasTimestamps(const Capabilities& capabilities) {
  if (capabilities.api != Api::Gl) return false;
  GLint bits = 0;
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  return bits > 0;
}

std::int64_t timestampNow() {
  GLint64 now = 0;
  glGetInteger64v(GL_TIMESTAMP, &now);
  return now;
}

std::optional<std::int64_t> Timestamp::result() const {
  GLuint isAvailable = GL_FALSE;
  glGetQueryObjectuiv(name_.get(), GL_QUERY_RESULT_AVAILABLE, &isAvailable);
  if (isAvailable == GL_FALSE) return std::nullopt;
  GLuint64 time = 0;
  glGetQueryObjectui64v(name_.get(), GL_QUERY_RESULT, &time);
  return static_cast<std::int64_t>(time);
}

}  // namespace sk::gl
