// SPDX-License-Identifier: MIT
#include "assemble/glsl/exact_sums.hpp"

namespace sk::assemble {

std::string_view exactExtensions(Barrier barrier) {
  return barrier == Barrier::Precise ? "#extension GL_ARB_gpu_shader5 : require\n" : "";
}

std::string_view exactDefinitions(Barrier barrier) {
  switch (barrier) {
    case Barrier::None:
      return R"(
#define sk_precise
#define sk_keep(x) (x)
)";
    case Barrier::Xor:
      return R"(
#define sk_precise
uniform uint sk_zero;   // never set, hence 0
float sk_keep(float x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec2 sk_keep(vec2 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec3 sk_keep(vec3 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
vec4 sk_keep(vec4 x) { return uintBitsToFloat(floatBitsToUint(x) ^ sk_zero); }
)";
    case Barrier::Precise:
      return R"(
#define sk_precise precise
#define sk_keep(x) (x)
)";
  }
  return {};
}

}  // namespace sk::assemble
