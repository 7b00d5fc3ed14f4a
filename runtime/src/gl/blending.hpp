// SPDX-License-Identifier: MIT
//
// How draws change the texels of their targets: how the values of points blend with stored texels, and which components
// draws write. Points cover one texel each and are drawn in order.
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

using ColorMask = std::array<bool, 4>;

/// Draws write these components as long as this object lives, and all components otherwise.
class ColorMaskScope {
 public:
  ColorMaskScope(BoundState& bound, const ColorMask& mask) {
    bound.spoil();
    set(mask);
  }
  ~ColorMaskScope() { set({true, true, true, true}); }
  ColorMaskScope(const ColorMaskScope&) = delete;
  ColorMaskScope& operator=(const ColorMaskScope&) = delete;

 private:
  static void set(const ColorMask& mask);
};

}  // namespace sk::gl
