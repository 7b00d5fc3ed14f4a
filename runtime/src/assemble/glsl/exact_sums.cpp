// SPDX-License-Identifier: MIT
//
// Selects the definitions for a barrier (exact_sums.glsl).
#include "assemble/glsl/exact_sums.hpp"

#include "glsl_text/exact_sums.hpp"

namespace sk::assemble {

std::string_view exactExtensions(const Profile& profile) {
  const bool hasPrecise = profile.stage == Stage::Compute;  // GLSL 4.30
  return profile.barrier == Barrier::Precise && !hasPrecise ? "#extension GL_ARB_gpu_shader5 : require\n"
                                                            : "";
}

std::string_view exactDefinitions(Barrier barrier) {
  switch (barrier) {
    case Barrier::None: return library::withoutBarrier;
    case Barrier::Xor: return library::xorBarrier;
    case Barrier::Precise: return library::preciseBarrier;
  }
  return {};
}

}  // namespace sk::assemble
