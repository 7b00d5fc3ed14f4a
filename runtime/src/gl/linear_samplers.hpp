// SPDX-License-Identifier: MIT
//
// The samplers through which programs read gathers that are declared [[filter]]: linear, one for each
// boundary mode that samplers have, made when first needed. Where one is bound to a unit, the settings of
// the texture there do not count.
#pragma once

#include <array>
#include <cstddef>

#include "gl/object_name.hpp"
#include "sk/program.hpp"

namespace sk::gl {

inline void deleteSampler(GLuint name) { glDeleteSamplers(1, &name); }

class LinearSamplers {
 public:
  /// Not for Boundary::Border, which programs compute. The context must be current.
  GLuint name(program::Boundary boundary) {
    constexpr std::array<GLint, 3> wraps = {GL_CLAMP_TO_EDGE, GL_REPEAT, GL_MIRRORED_REPEAT};
    const auto mode = static_cast<std::size_t>(boundary);
    if (!names_[mode]) {
      GLuint name = 0;
      glGenSamplers(1, &name);
      names_[mode] = Name(name);
      glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
      glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
      glSamplerParameteri(name, GL_TEXTURE_WRAP_S, wraps[mode]);
      glSamplerParameteri(name, GL_TEXTURE_WRAP_T, wraps[mode]);
    }
    return names_[mode].get();
  }

  void clear() { names_ = {}; }
  void forget() noexcept {
    for (Name& name : names_) {
      name.forget();
    }
  }

 private:
  using Name = ObjectName<deleteSampler>;
  std::array<Name, 3> names_;   ///< for Clamp, Wrap, Mirror
};

}  // namespace sk::gl
