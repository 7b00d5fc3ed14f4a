// SPDX-License-Identifier: MIT
//
// The GL state that passes depend on, besides bindings. It is set once in a context of our own; in an adopted
// context, each call saves, sets and restores it.
#pragma once

#include <array>
#include <cstddef>

#include <epoxy/gl.h>

#include "gl/bound_state.hpp"
#include "gl/capabilities.hpp"

namespace sk::gl {

/// Sets all state that affects what a pass writes, or where, and how texels are transferred: tests, blending,
/// masks, pixel storage.
void setPassState(const Capabilities& capabilities);

/// Saves the application's state and calls setPassState; the destructor restores the state. `bound` tracks
/// the bindings in between. Requires GL 3.0, ES 3.0 or later.
class SavedState {
 public:
  SavedState(const Capabilities& capabilities, BoundState& bound);
  ~SavedState();
  SavedState(const SavedState&) = delete;
  SavedState& operator=(const SavedState&) = delete;

  /// The rows of each kind in pass_state.def.
  static constexpr std::size_t toggles = 0
#define SK_TOGGLE(name, needs) +1
#include "gl/pass_state.def"
      ;
  static constexpr std::size_t pixelStores = 0
#define SK_PIXEL_STORE(name, value, needs) +1
#include "gl/pass_state.def"
      ;
  static constexpr std::size_t states = 0
#define SK_STATE(name, set, value, needs) +1
#include "gl/pass_state.def"
      ;
  static constexpr std::size_t bindings = 0
#define SK_BINDING(name, bind, needs) +1
#include "gl/pass_state.def"
      ;

 private:
  void saveRows();
  void restoreRows() const;
  void saveViewport();
  void restoreViewport() const;
  void saveDrawBuffers();
  void restoreDrawBuffers() const;
  void pauseFeedback();

  const Capabilities& capabilities_;
  BoundState& bound_;
  // In the order of the rows.
  std::array<bool, toggles> toggles_{};
  std::array<GLint, pixelStores> pixelStores_{};
  std::array<GLfloat, states> states_{};
  std::array<GLint, bindings> bindings_{};
  std::array<GLfloat, 4> viewport_{};
  std::array<bool, maxDrawBuffers> blend_{};
  std::array<std::array<GLboolean, 4>, maxDrawBuffers> colorMask_{};
  std::array<GLint, 2> polygonMode_{};
  GLint clipOrigin_ = 0, clipDepth_ = 0;
  GLint activeUnit_ = 0;
  bool isScissored_ = false;
  bool isFeedbackPaused_ = false;
};

}  // namespace sk::gl
