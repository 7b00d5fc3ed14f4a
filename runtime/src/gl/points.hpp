// SPDX-License-Identifier: MIT
//
// Points, one a texel, and how what they write combines with what is there. Points are drawn in order.
#pragma once

#include <array>

#include <epoxy/gl.h>

#include "gl/capabilities.hpp"

namespace sk::gl {

enum class Blend { None, Add, Min, Max };

/// Blending of floats for as long as this lives. In an adopted context the application's equations and
/// factors are put back; in our own nobody else blends.
class Blending {
 public:
  Blending(const Capabilities& capabilities, Blend blend, bool isApplications);
  ~Blending();
  Blending(const Blending&) = delete;
  Blending& operator=(const Blending&) = delete;

 private:
  /// Equations of colour and alpha; factors of the source's colour, the target's, and both of alpha.
  using Settings = std::array<GLint, 6>;

  const Capabilities& capabilities_;
  const bool isOn_;
  const bool isKept_;
  std::array<Settings, maxDrawBuffers> kept_{};
};

/// Draws `count` points with what is bound; the vertex program places them by gl_VertexID.
inline void drawPoints(GLsizei count) { glDrawArrays(GL_POINTS, 0, count); }

}  // namespace sk::gl
