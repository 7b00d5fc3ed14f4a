// SPDX-License-Identifier: MIT
//
// The samplers through which programs read streams, created on first use: a nearest one and, for gathers
// declared [[filter]], a linear one per boundary mode that samplers support. A bound sampler overrides the
// texture's settings, which an application may have changed for drawing.
#pragma once

#include <array>
#include <cstddef>

#include "gl/object_name.hpp"
#include "sk/program.hpp"

namespace sk::gl {

inline void deleteSampler(BoundState&, GLuint name) { glDeleteSamplers(1, &name); }

class Samplers {
 public:
  explicit Samplers(Deletions& deletions) : deletions_(deletions) {}

  /// The context must be current.
  GLuint nearest() {
    if (!nearest_) nearest_ = made(GL_NEAREST, GL_CLAMP_TO_EDGE);
    return nearest_.get();
  }

  /// Not for Boundary::Border, which programs implement. The context must be current.
  GLuint linear(program::Boundary boundary) {
    constexpr std::array<GLint, 3> wraps = {GL_CLAMP_TO_EDGE, GL_REPEAT, GL_MIRRORED_REPEAT};
    const auto mode = static_cast<std::size_t>(boundary);
    if (!linear_[mode]) linear_[mode] = made(GL_LINEAR, wraps[mode]);
    return linear_[mode].get();
  }

 private:
  using Name = ObjectName<deleteSampler>;

  Name made(GLint filter, GLint wrap) const {
    Name name(deletions_, [] { return generated(glGenSamplers); });
    glSamplerParameteri(name.get(), GL_TEXTURE_MIN_FILTER, filter);
    glSamplerParameteri(name.get(), GL_TEXTURE_MAG_FILTER, filter);
    glSamplerParameteri(name.get(), GL_TEXTURE_WRAP_S, wrap);
    glSamplerParameteri(name.get(), GL_TEXTURE_WRAP_T, wrap);
    return name;
  }

  Deletions& deletions_;
  Name nearest_;
  std::array<Name, 3> linear_;  ///< for Clamp, Wrap, Mirror
};

}  // namespace sk::gl
