// SPDX-License-Identifier: MIT
//
// The samplers through which programs read streams, made when first needed: a nearest one and, for gathers that are
// declared [[filter]], a linear one for each boundary mode that samplers have. Where one is bound to a unit, the settings
// of the texture there do not count, which an application may have changed to draw with it.
#pragma once

#include <array>
#include <cstddef>

#include "gl/object_name.hpp"
#include "sk/program.hpp"

namespace sk::gl {

inline void deleteSampler(GLuint name) { glDeleteSamplers(1, &name); }

class Samplers {
 public:
  /// The context must be current.
  GLuint nearest() {
    if (!nearest_) nearest_ = made(GL_NEAREST, GL_CLAMP_TO_EDGE);
    return nearest_.get();
  }

  /// Not for Boundary::Border, which programs compute. The context must be current.
  GLuint linear(program::Boundary boundary) {
    constexpr std::array<GLint, 3> wraps = {GL_CLAMP_TO_EDGE, GL_REPEAT, GL_MIRRORED_REPEAT};
    const auto mode = static_cast<std::size_t>(boundary);
    if (!linear_[mode]) linear_[mode] = made(GL_LINEAR, wraps[mode]);
    return linear_[mode].get();
  }

  void clear() {
    nearest_ = {};
    linear_ = {};
  }
  void forget() noexcept {
    nearest_.forget();
    for (Name& name : linear_) {
      name.forget();
    }
  }

 private:
  using Name = ObjectName<deleteSampler>;

  static Name made(GLint filter, GLint wrap) {
    GLuint name = 0;
    glGenSamplers(1, &name);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, filter);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, wrap);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, wrap);
    return Name(name);
  }

  Name nearest_;
  std::array<Name, 3> linear_;  ///< for Clamp, Wrap, Mirror
};

}  // namespace sk::gl
