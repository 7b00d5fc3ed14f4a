// SPDX-License-Identifier: MIT
//
// Selects the definitions of doubles for a representation (doubles.glsl).
#include "assemble/glsl/doubles.hpp"

#include "glsl_text/doubles.hpp"

namespace sk::assemble {

std::string_view doubleExtensions(Doubles form) {
  return form == Doubles::Native ? "#extension GL_ARB_gpu_shader_fp64 : require\n" : "";
}

std::string doubleDefinitions(Doubles form) {
  return std::string(form == Doubles::Native ? library::native : library::pair).append(library::common);
}

}  // namespace sk::assemble
