// SPDX-License-Identifier: MIT
//
// Selects the definitions of doubles for a representation (doubles.glsl).
#include "assemble/glsl/doubles.hpp"

#include "glsl_text/doubles.hpp"

namespace sk::assemble {

std::string_view doubleExtensions(Doubles form) {
  return form == Doubles::Native ? "#extension GL_ARB_gpu_shader_fp64 : require\n" : "";
}

std::string doubleDefinitions(Doubles form, Barrier own) {
  if (form == Doubles::Pairs) return std::string(library::pair).append(library::common);
  const std::string_view definition =
      own == Barrier::Precise ? "#define sk_written precise\n" : "#define sk_written\n";
  return std::string(definition).append(library::native).append(library::common);
}

}  // namespace sk::assemble
