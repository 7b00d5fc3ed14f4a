// SPDX-License-Identifier: MIT
//
// A uniform whose value lies in a stream changes two places of a program: one line declares its textures, and main() begins with what
// fetches the value. The runtime makes both changes itself, so that no combination of such uniforms needs a program:
//   uniform float sk_arg_k;      uniform sampler2D sk_tex_k;
//                                uniform ivec4 sk_origin_k;
//   void main() {                void main() {
//                                  float sk_arg_k = texelFetch(sk_tex_k, sk_origin_k.xy, 0).x;
// Both texts are the assembler's.
#include <algorithm>

#include "assemble/elements/arguments.hpp"
#include "assemble/glsl/own_arithmetic.hpp"
#include "web/ahead_programs.hpp"

namespace skc::web {

using sk::program::Scalar;

HeldValue heldValue(const sk::assemble::Profile& profile, const sk::program::Parameter& uniform) {
  const bool widensVectors = uniform.held != nullptr &&
                             std::ranges::any_of(uniform.held->fields, [](const sk::program::Field& field) {
                               return field.scalar == Scalar::Float && field.width > 1;
                             });
  if (widensVectors) return {};  // by a function that the program may have, too
  sk::assemble::ProgramText program(profile);
  sk::assemble::uniformValue(program, uniform, {.addressing = sk::assemble::Addressing::Plane, .view = true});
  return {sk::assemble::unmarked(program.ownText()), sk::assemble::unmarked(program.statements())};
}

bool isPlain(const sk::program::Parameter& uniform) {
  const sk::program::Field& field = heldBy(uniform).fields.front();
  const bool isOne = heldBy(uniform).fields.size() == 1 && field.path.empty() && field.part < 0;
  return isOne && uniform.held == nullptr &&
         (field.scalar == Scalar::Float || field.scalar == Scalar::Int || field.scalar == Scalar::Uint);
}

}  // namespace skc::web
