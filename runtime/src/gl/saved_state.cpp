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
constexpr std::array allToggles = {
#define SK_TOGGLE(name, needs) Toggle{name, Needs::needs},
#include "gl/pass_state.def"
};

struct PixelStore {
  GLenum name;
  GLint value;  ///< during a pass
  Needs needs;
};
constexpr std::array allPixelStores = {
#define SK_PIXEL_STORE(name, value, needs) PixelStore{name, value, Needs::needs},
#include "gl/pass_state.def"
};

// What sets state that has no function of its own.
template <GLenum target>
void clamp(GLfloat value) {
  glClampColor(target, static_cast<GLenum>(value));
}
template <GLenum name>
void transfer(GLfloat value) {
  glPixelTransferf(name, value);
}
template <GLenum target>
void bindFramebuffer(GLuint name) {
  glBindFramebuffer(target, name);
}
template <GLenum target>
void bindBuffer(GLuint name) {
  glBindBuffer(target, name);
}

struct State {
  GLenum name;
  void (*set)(GLfloat value);
  GLfloat value;  ///< during a pass
  Needs needs;
};
constexpr std::array allStates = {
#define SK_STATE(name, set, value, needs) State{name, [](GLfloat v) { set(v); }, value, Needs::needs},
#include "gl/pass_state.def"
};

struct Binding {
  GLenum name;
  void (*bind)(GLuint name);
  Needs needs;
};
constexpr std::array allBindings = {
#define SK_BINDING(name, bind, needs) Binding{name, [](GLuint object) { bind(object); }, Needs::needs},
#include "gl/pass_state.def"
};

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
  for (const Toggle& toggle : allToggles) {
    if (has(toggle.needs, capabilities)) glDisable(toggle.name);
  }
  for (const PixelStore& parameter : allPixelStores) {
    if (has(parameter.needs, capabilities)) glPixelStorei(parameter.name, parameter.value);
  }
  for (const State& state : allStates) {
    if (has(state.needs, capabilities)) state.set(state.value);
  }
  if (hasIndexedViewports(capabilities)) {
    glDisablei(GL_SCISSOR_TEST, 0);
  } else {
    glDisable(GL_SCISSOR_TEST);
  }
  if (capabilities.hasClipControl) setClipControl(capabilities, GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDisable(GL_BLEND);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  bindBuffer<GL_PIXEL_PACK_BUFFER>(0);
  bindBuffer<GL_PIXEL_UNPACK_BUFFER>(0);
  if (capabilities.api == Api::Gl) glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

SavedState::SavedState(const Capabilities& capabilities, BoundState& bound)
    : capabilities_(capabilities), bound_(bound) {
  activeUnit_ = savedInteger(GL_ACTIVE_TEXTURE);
  saveRows();
  saveViewport();
  saveDrawBuffers();
  pauseFeedback();
  setPassState(capabilities);
  bound.enterApplication(hasIndexedViewports(capabilities));
}

SavedState::~SavedState() {
  bound_.leaveApplication(activeUnit_);
  restoreRows();
  restoreDrawBuffers();
  restoreViewport();
  if (isFeedbackPaused_) {
    glResumeTransformFeedback();
  }
}

void SavedState::saveRows() {
  for (std::size_t i = 0; i < toggles_.size(); ++i)
    toggles_[i] = has(allToggles[i].needs, capabilities_) && glIsEnabled(allToggles[i].name) == GL_TRUE;
  for (std::size_t i = 0; i < pixelStores_.size(); ++i) {
    if (has(allPixelStores[i].needs, capabilities_)) glGetIntegerv(allPixelStores[i].name, &pixelStores_[i]);
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (has(allStates[i].needs, capabilities_)) glGetFloatv(allStates[i].name, &states_[i]);
  }
  for (std::size_t i = 0; i < bindings_.size(); ++i) {
    if (has(allBindings[i].needs, capabilities_)) bindings_[i] = savedInteger(allBindings[i].name);
  }
}

void SavedState::restoreRows() const {
  for (std::size_t i = 0; i < bindings_.size(); ++i) {
    if (has(allBindings[i].needs, capabilities_)) allBindings[i].bind(static_cast<GLuint>(bindings_[i]));
  }
  for (std::size_t i = 0; i < states_.size(); ++i) {
    if (has(allStates[i].needs, capabilities_)) allStates[i].set(states_[i]);
  }
  for (std::size_t i = 0; i < pixelStores_.size(); ++i) {
    if (has(allPixelStores[i].needs, capabilities_)) glPixelStorei(allPixelStores[i].name, pixelStores_[i]);
  }
  for (std::size_t i = 0; i < toggles_.size(); ++i) {
    if (toggles_[i]) glEnable(allToggles[i].name);
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
  if (capabilities_.api == Api::Gl) glGetIntegerv(GL_POLYGON_MODE, polygonMode_.data());
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

// Active transform feedback would capture a draw, and forbids changing the program.
void SavedState::pauseFeedback() {
  if (hasFeedbackPause(capabilities_) && savedInteger(GL_TRANSFORM_FEEDBACK_ACTIVE) != 0 &&
      savedInteger(GL_TRANSFORM_FEEDBACK_PAUSED) == 0) {
    glPauseTransformFeedback();
    isFeedbackPaused_ = true;
  }
}

}  // namespace sk::gl
