// SPDX-License-Identifier: MIT
//
// A uniform whose value lies in a stream changes two places of a program: one line declares its textures, and main() begins with what
// fetches the value. The runtime makes both changes itself, so that no combination of such uniforms needs a program:
//   uniform float sk_arg_k;      uniform sampler2D sk_tex_k;
//                                uniform ivec4 sk_origin_k;
//   void main() {                void main() {
//                                  float sk_arg_k = texelFetch(sk_tex_k, sk_origin_k.xy, 0).x;
// The assembler is asked for both texts, of a kernel with this parameter alone.
#include <string_view>

#include <fmt/format.h>

#include "web/ahead_programs.hpp"

namespace skc::web {
namespace {

/// The lines of a text that begin with `start`.
std::string linesWith(std::string_view start, std::string_view text) {
  std::string lines;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n') + 1);
    if (line.starts_with(start)) lines += line;
    text.remove_prefix(line.size());
  }
  return lines;
}

}  // namespace

HeldValue heldValue(sk::assemble::Profile profile, const sk::program::Kernel& kernel,
                    const sk::program::Parameter& uniform) {
  constexpr std::string_view entry = "sk_nothing";
  profile.asWritten = false;  // the program may have nothing that keeps floats
  sk::program::Kernel alone{.name = uniform.name,
                            .entry = entry,
                            .declarations = {},
                            .body = {},
                            .parameters = {&uniform, 1},
                            .sources = {}};
  alone.usesDoubles = kernel.usesDoubles;
  sk::assemble::Variant variant;
  variant.access = {{.addressing = sk::assemble::Addressing::Plane, .view = true}};
  const std::string text = sk::assemble::kernelProgram(profile, alone, variant);
  constexpr std::string_view main = "void main() {\n";
  const std::size_t begin = text.rfind(main) + main.size();
  const std::size_t end = text.rfind(fmt::format("  {}(", entry));
  const bool converts = text.find(" sk_widen") != std::string::npos;
  if (converts) return {};  // the program may have that function, too
  const std::string_view whole = text;
  const std::string_view first = whole.substr(0, whole.rfind(main));
  std::string uniforms;
  for (const std::string_view type : {"sampler2D", "isampler2D", "usampler2D", "ivec4"})
    uniforms += linesWith(fmt::format("uniform {} sk_", type), first);
  // If the value has several planes, a function combines them.
  const std::size_t function =
      first.find(fmt::format("\n{} sk_fetch_{}(", uniform.element->glsl, uniform.symbol));
  if (function != std::string_view::npos) {
    constexpr std::string_view last = "\n}\n";
    uniforms += first.substr(function + 1, first.find(last, function) + last.size() - function - 1);
  }
  return {uniforms, std::string(whole.substr(begin, end - begin))};
}

bool isPlain(const sk::program::Parameter& uniform) {
  using sk::program::Scalar;
  const sk::program::Field& field = heldBy(uniform).fields.front();
  const bool isOne = heldBy(uniform).fields.size() == 1 && field.path.empty() && field.part < 0;
  return isOne && uniform.held == nullptr &&
         (field.scalar == Scalar::Float || field.scalar == Scalar::Int || field.scalar == Scalar::Uint);
}

}  // namespace skc::web
