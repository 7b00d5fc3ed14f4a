// SPDX-License-Identifier: MIT
//
// The GL state that passes depend on, besides bindings. It is set once in a context of our own; in an adopted
// context, each call saves, sets and restores it.
#pragma once

#include <array>

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

  static constexpr std::size_t toggleCount = 22;
  static constexpr std::size_t pixelStoreCount = 16;
  static constexpr std::size_t pixelTransferCount = 9;

 private:
  void saveViewport();
  void restoreViewport() const;
  void saveDrawBuffers();
  void restoreDrawBuffers() const;
  void saveTransfer();
  void restoreTransfer() const;
  void pauseFeedback();

  const Capabilities& capabilities_;
  BoundState& bound_;
  std::array<bool, toggleCount> toggles_{};  ///< in the order of the table of toggles
  std::array<GLint, pixelStoreCount> pixelStore_{};  ///< in the order of the table of parameters
  std::array<GLfloat, 4> viewport_{};
  std::array<bool, maxDrawBuffers> blend_{};
  std::array<std::array<GLboolean, 4>, maxDrawBuffers> colorMask_{};
  std::array<GLint, 2> polygonMode_{};
  GLint program_ = 0, vertexArray_ = 0, drawFramebuffer_ = 0, readFramebuffer_ = 0;
  GLint clipOrigin_ = 0, clipDepth_ = 0;
  std::array<GLfloat, pixelTransferCount> pixelTransfer_{};  ///< likewise
  GLint clampFragmentColor_ = 0, clampVertexColor_ = 0;
  GLint activeUnit_ = 0, packBuffer_ = 0, unpackBuffer_ = 0, clampReadColor_ = 0;
  GLfloat pointSize_ = 1;
  bool isScissored_ = false;
  bool isFeedbackPaused_ = false;
};

}  // namespace sk::gl
