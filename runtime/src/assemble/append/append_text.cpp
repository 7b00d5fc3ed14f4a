// SPDX-License-Identifier: MIT
#include "assemble/append/append_text.hpp"

#include <array>
#include <string_view>

#include <fmt/format.h>

namespace sk::assemble {

using program::Parameter;
using program::Role;

namespace {

std::string_view indexType(const Parameter& scatter) {
  static constexpr std::array<std::string_view, 5> types = {"", "int", "ivec2", "ivec3", "ivec4"};
  return types[scatter.rank];
}

}  // namespace

std::string signatureOf(const Parameter& appendOutput) {
  if (appendOutput.role == Role::VariableOutput) {
    return fmt::format("void sk_push_{}({} sk_v)", appendOutput.symbol, appendOutput.element->glsl);
  }
  return fmt::format("void sk_put_{}({} sk_i, {} sk_v)", appendOutput.symbol, indexType(appendOutput),
                     appendOutput.element->glsl);
}

std::string named(std::string_view kind, const Parameter& appendOutput) {
  return fmt::format("sk_{}_{}", kind, appendOutput.symbol);
}

std::string targetTexel(ProgramText& program, const Parameter& appendOutput, const StreamAccess& access) {
  static constexpr std::array<std::string_view, 5> swizzles = {"", ".x", ".xy", ".xyz", ""};
  const auto origin = [&](int rank) {
    return access.view ? fmt::format(" + {}{}", program.uniform("ivec4", named("origin", appendOutput)),
                                     swizzles[rank])
                       : "";
  };
  if (access.addressing == Addressing::Plane) {
    return appendOutput.rank == 1 ? fmt::format("ivec2(sk_i{}, 0)", origin(1))
                                  : fmt::format("sk_i{}{}", appendOutput.rank == 2 ? "" : ".xy", origin(2));
  }
  program.require(Function::Texel);
  const std::string shift = program.uniform("int", named("shift", appendOutput));
  const std::string index = "sk_i" + origin(appendOutput.rank);
  if (appendOutput.rank == 1) return fmt::format("sk_texel({}, {})", index, shift);
  const std::string stride = program.uniform("ivec4", named("stride", appendOutput));
  std::string number = fmt::format("({}).x", index);
  for (int c = 1; c < appendOutput.rank; ++c)
    number += fmt::format(" + ({0}).{1} * {2}.{1}", index, "xyzw"[c], stride);
  return fmt::format("sk_texel({}, {})", number, shift);
}

std::string isInside(ProgramText& program, const Parameter& appendOutput) {
  const std::string shape = program.uniform("ivec4", named("shape", appendOutput));
  if (appendOutput.rank == 1) return fmt::format("uint(sk_i) < uint({}.x)", shape);
  static constexpr std::array<std::string_view, 5> swizzles = {"", "", ".xy", ".xyz", ""};
  return fmt::format("all(lessThan(uvec{0}(sk_i), uvec{0}({1}{2})))", appendOutput.rank, shape,
                     swizzles[appendOutput.rank]);
}

}  // namespace sk::assemble
