// SPDX-License-Identifier: MIT
//
// Functions that save and restore each kind of the state that passes set (pass_state.def).
#include "gl/saved_state.hpp"

#include <algorithm>

namespace sk::gl {

namespace {

/// The contexts that have a piece of state.
enum class Needs { Nothing, Gl, Compatibility, Gl32OrEs31 };

bool has(Needs needs, const Capabilities& capabilities) {
  const bool isGl = capabilities.api == Api::Gl;
  switch (needs) {
    case Needs::Nothing: return true;
    case Needs::Gl: return isGl;
    case Needs::Compatibility: return capabilities.isCompatibility;
    case Needs::Gl32OrEs31: return capabilities.version >= (isGl ? 32 : 31);
  }
  return false;
}

struct Toggle {
  GLenum name;
  Needs needs;
};

constexpr auto toggles = std::to_array<Toggle>({
#define SK_TOGGLE(name, needs) {name, Needs::needs},
#define SK_PIXEL_STORE(name, value, needs)
#include "gl/pass_state.def"
#undef SK_TOGGLE
#undef SK_PIXEL_STORE
});
static_assert(toggles.size() == SavedState::toggleCount);

struct PixelParameter {
  GLenum name;
  GLint value;  ///< during a pass
  Needs needs;
};

constexpr auto pixelParameters = std::to_array<PixelParameter>({
#define SK_TOGGLE(name, needs)
#define SK_PIXEL_STORE(name, value, needs) {name, value, Needs::needs},
#include "gl/pass_state.def"
#undef SK_TOGGLE
#undef SK_PIXEL_STORE
});
static_assert(pixelParameters.size() == SavedState::pixelStoreCount);

struct PixelTransfer {
  GLenum name;
  GLfloat value;  ///< during a pass
};

/// How the fixed-function pipeline transforms texels in transfers, in compatibility contexts.
constexpr std::array<PixelTransfer, SavedState::pixelTransferCount> pixelTransfers{{
    {GL_MAP_COLOR, 0},
    {GL_RED_SCALE, 1},
    {GL_GREEN_SCALE, 1},
    {GL_BLUE_SCALE, 1},
    {GL_ALPHA_SCALE, 1},
    {GL_RED_BIAS, 0},
    {GL_GREEN_BIAS, 0},
    {GL_BLUE_BIAS, 0},
    {GL_ALPHA_BIAS, 0},
}};

/// Whether each draw buffer has its own blending and colour masks.
bool hasIndexedDrawBuffers(const Capabilities& c) { return c.api == Api::Gl || c.version >= 32; }

/// Whether there are several viewports, all of which glViewport sets.
bool hasIndexedViewports(const Capabilities& c) { return c.api == Api::Gl && c.version >= 41; }

bool hasFeedbackPause(const Capabilities& c) { return c.api == Api::Es || c.version >= 40; }

GLint savedInteger(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

/// GL and ES have different functions with the same values.
void setClipControl(const Capabilities& c, GLint origin, GLint depth) {
  const auto set = c.api == Api::Gl ? glClipControl : glClipControlEXT;
  set(static_cast<GLenum>(origin), static_cast<GLenum>(depth));
}

void set(GLenum name, bool isOn) { isOn ? glEnable(name) : glDisable(name); }

}  // namespace

void setPassState(const Capabilities& capabilities) {
  for (const Toggle& toggle : toggles) {
    if (has(toggle.needs, capabilities)) {
      glDisable(toggle.name);
    }
  }
  for (const PixelParameter& parameter : pixelParameters) {
    if (has(parameter.needs, capabilities)) {
      glPixelStorei(parameter.name, parameter.value);
    }
  }
  if (hasIndexedViewports(capabilities)) {
    glDisablei(GL_SCISSOR_TEST, 0);
  } else {
    glDisable(GL_SCISSOR_TEST);
  }
  if (capabilities.hasClipControl) setClipControl(capabilities, GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
  if (capabilities.api == Api::Gl) {
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    glPointSize(1);
    glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
  }
  if (capabilities.isCompatibility) {
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
    glClampColor(GL_CLAMP_VERTEX_COLOR, GL_FALSE);
    for (const PixelTransfer& transfer : pixelTransfers) glPixelTransferf(transfer.name, transfer.value);
  }
}

SavedState::SavedState(const Capabilities& capabilities, BoundState& bound)
    : capabilities_(capabilities), bound_(bound) {
  for (std::size_t i = 0; i < toggles.size(); ++i) {
    toggles_[i] = has(toggles[i].needs, capabilities) && glIsEnabled(toggles[i].name) == GL_TRUE;
  }
  program_ = savedInteger(GL_CURRENT_PROGRAM);
  vertexArray_ = savedInteger(GL_VERTEX_ARRAY_BINDING);
  drawFramebuffer_ = savedInteger(GL_DRAW_FRAMEBUFFER_BINDING);
  readFramebuffer_ = savedInteger(GL_READ_FRAMEBUFFER_BINDING);
  activeUnit_ = savedInteger(GL_ACTIVE_TEXTURE);
  saveViewport();
  saveDrawBuffers();
  saveTransfer();
  pauseFeedback();
  setPassState(capabilities);
  bound.enterApplication(hasIndexedViewports(capabilities));
}

SavedState::~SavedState() {
  bound_.leaveApplication(activeUnit_);
  glUseProgram(static_cast<GLuint>(program_));
  glBindVertexArray(static_cast<GLuint>(vertexArray_));
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(drawFramebuffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(readFramebuffer_));
  restoreTransfer();
  restoreDrawBuffers();
  restoreViewport();
  for (std::size_t i = 0; i < toggles.size(); ++i) {
    if (toggles_[i]) {
      glEnable(toggles[i].name);
    }
  }
  if (isFeedbackPaused_) {
    glResumeTransformFeedback();
  }
}

// GL_POLYGON_MODE returns two values in compatibility contexts and one in core contexts.
void SavedState::saveViewport() {
  isScissored_ = glIsEnabled(GL_SCISSOR_TEST) == GL_TRUE;
  if (hasIndexedViewports(capabilities_)) {
    glGetFloati_v(GL_VIEWPORT, 0, viewport_.data());
  } else {
    glGetFloatv(GL_VIEWPORT, viewport_.data());
  }
  if (capabilities_.hasClipControl) {
    clipOrigin_ = savedInteger(GL_CLIP_ORIGIN);
    clipDepth_ = savedInteger(GL_CLIP_DEPTH_MODE);
  }
  if (capabilities_.api == Api::Gl) {
    glGetIntegerv(GL_POLYGON_MODE, polygonMode_.data());
    glGetFloatv(GL_POINT_SIZE, &pointSize_);
  }
}

void SavedState::restoreViewport() const {
  if (hasIndexedViewports(capabilities_)) {
    glViewportIndexedfv(0, viewport_.data());
    isScissored_ ? glEnablei(GL_SCISSOR_TEST, 0) : glDisablei(GL_SCISSOR_TEST, 0);
  } else {
    glViewport(static_cast<GLint>(viewport_[0]), static_cast<GLint>(viewport_[1]),
               static_cast<GLsizei>(viewport_[2]), static_cast<GLsizei>(viewport_[3]));
    set(GL_SCISSOR_TEST, isScissored_);
  }
  if (capabilities_.hasClipControl) setClipControl(capabilities_, clipOrigin_, clipDepth_);
  if (capabilities_.api == Api::Gl) {
    glPointSize(pointSize_);
  }
  if (capabilities_.isCompatibility) {
    glPolygonMode(GL_FRONT, static_cast<GLenum>(polygonMode_[0]));
    glPolygonMode(GL_BACK, static_cast<GLenum>(polygonMode_[1]));
  } else if (capabilities_.api == Api::Gl) {
    glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygonMode_[0]));
  }
}

void SavedState::saveDrawBuffers() {
  if (!hasIndexedDrawBuffers(capabilities_)) {
    blend_[0] = glIsEnabled(GL_BLEND) == GL_TRUE;
    glGetBooleanv(GL_COLOR_WRITEMASK, colorMask_[0].data());
    return;
  }
  for (int i = 0; i < capabilities_.drawBuffers; ++i) {
    const auto buffer = static_cast<std::size_t>(i);
    blend_[buffer] = glIsEnabledi(GL_BLEND, static_cast<GLuint>(i)) == GL_TRUE;
    glGetBooleani_v(GL_COLOR_WRITEMASK, static_cast<GLuint>(i), colorMask_[buffer].data());
  }
}

void SavedState::restoreDrawBuffers() const {
  if (!hasIndexedDrawBuffers(capabilities_)) {
    set(GL_BLEND, blend_[0]);
    const auto& mask = colorMask_[0];
    glColorMask(mask[0], mask[1], mask[2], mask[3]);
    return;
  }
  for (int i = 0; i < capabilities_.drawBuffers; ++i) {
    const auto& mask = colorMask_[static_cast<std::size_t>(i)];
    glColorMaski(static_cast<GLuint>(i), mask[0], mask[1], mask[2], mask[3]);
    if (blend_[static_cast<std::size_t>(i)]) {
      glEnablei(GL_BLEND, static_cast<GLuint>(i));
    }
  }
}

void SavedState::saveTransfer() {
  for (std::size_t i = 0; i < pixelParameters.size(); ++i) {
    if (has(pixelParameters[i].needs, capabilities_)) {
      glGetIntegerv(pixelParameters[i].name, &pixelStore_[i]);
    }
  }
  packBuffer_ = savedInteger(GL_PIXEL_PACK_BUFFER_BINDING);
  unpackBuffer_ = savedInteger(GL_PIXEL_UNPACK_BUFFER_BINDING);
  if (capabilities_.api == Api::Gl) {
    clampReadColor_ = savedInteger(GL_CLAMP_READ_COLOR);
  }
  if (capabilities_.isCompatibility) {
    clampFragmentColor_ = savedInteger(GL_CLAMP_FRAGMENT_COLOR);
    clampVertexColor_ = savedInteger(GL_CLAMP_VERTEX_COLOR);
    for (std::size_t i = 0; i < pixelTransfers.size(); ++i) {
      glGetFloatv(pixelTransfers[i].name, &pixelTransfer_[i]);
    }
  }
}

void SavedState::restoreTransfer() const {
  for (std::size_t i = 0; i < pixelParameters.size(); ++i) {
    if (has(pixelParameters[i].needs, capabilities_)) {
      glPixelStorei(pixelParameters[i].name, pixelStore_[i]);
    }
  }
  glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(packBuffer_));
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpackBuffer_));
  if (capabilities_.api == Api::Gl) {
    glClampColor(GL_CLAMP_READ_COLOR, static_cast<GLenum>(clampReadColor_));
  }
  if (capabilities_.isCompatibility) {
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, static_cast<GLenum>(clampFragmentColor_));
    glClampColor(GL_CLAMP_VERTEX_COLOR, static_cast<GLenum>(clampVertexColor_));
    for (std::size_t i = 0; i < pixelTransfers.size(); ++i) {
      glPixelTransferf(pixelTransfers[i].name, pixelTransfer_[i]);
    }
  }
}

// Active transform feedback would capture a draw, and forbids changing the program.
void SavedState::pauseFeedback() {
  if (hasFeedbackPause(capabilities_) && savedInteger(GL_TRANSFORM_FEEDBACK_ACTIVE) != 0 &&
      savedInteger(GL_TRANSFORM_FEEDBACK_PAUSED) == 0) {
    glPauseTransformFeedback();
    isFeedbackPaused_ = true;
  }
}

}  // namespace sk::gl
