// SPDX-License-Identifier: MIT
//
// Points of one texel, and how they blend with stored texels. Points are drawn in order.
#pragma once

#include <array>

#include <epoxy/gl.h>

#include "gl/bound_state.hpp"
#include "gl/capabilities.hpp"

namespace sk::gl {

enum class Blend { None, Add, Min, Max };

/// Blends floats as long as this object lives. Restores the application's equations and factors in an adopted
/// context; in our own, nothing else blends.
class Blending {
 public:
  Blending(const Capabilities& capabilities, Blend blend, bool isApplicationContext);
  ~Blending();
  Blending(const Blending&) = delete;
  Blending& operator=(const Blending&) = delete;

 private:
  /// Equations for colour and alpha; source and target factors for colour, then for alpha.
  using Settings = std::array<GLint, 6>;

  const Capabilities& capabilities_;
  const bool isOn_;
  const bool isKept_;
  std::array<Settings, maxDrawBuffers> kept_{};
};

/// Draws `count` points with the current bindings; the vertex program computes positions from gl_VertexID.
inline void drawPoints(BoundState& bound, GLsizei count) {
  bound.spoil();
  glDrawArrays(GL_POINTS, 0, count);
}

}  // namespace sk::gl
