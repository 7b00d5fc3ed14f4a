// SPDX-License-Identifier: MIT
//
// Generates the arguments of the entry function.
#include "assemble/elements/arguments.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>

#include "assemble/condition.hpp"
#include "sk/arithmetic_marks.hpp"

namespace sk::assemble {

using program::Parameter;

std::string parameterUniform(ProgramText& program, std::string_view type, std::string_view kind,
                             const Parameter& parameter) {
  return program.uniform(type, fmt::format("sk_{}_{}", kind, parameter.symbol));
}

std::string uniformValue(ProgramText& program, const Parameter& uniform, const StreamAccess& access) {
  const std::string_view type = uniform.element->glsl;
  if (!access.view) return parameterUniform(program, type, "arg", uniform);
  const bool isLayered = access.addressing == Addressing::Layered;
  declareSamplers(program, uniform, isLayered);
  const Texel texel{parameterUniform(program, "ivec4", "origin", uniform) + ".xy",
                    isLayered ? parameterUniform(program, "int", "shift", uniform) : "", access.packed};
  const std::string name = fmt::format("sk_arg_{}", uniform.symbol);
  program.statement(fmt::format("{} {} = {};", type, name, fetch(program, uniform, texel)));
  return name;
}

void defineGetter(ProgramText& program, std::string_view kind, const Parameter& parameter,
                  std::string_view value) {
  program.function(fmt::format("ivec4 sk_{}_{}()", kind, parameter.symbol),
                   {fmt::format("return {};", value)});
}

void defineExtent(ProgramText& program, const Parameter& parameter, std::string_view kind) {
  if (!parameter.usesExtent) return;
  defineGetter(program, "extent", parameter, parameterUniform(program, "ivec4", kind, parameter));
}

void defineInputIndex(ProgramText& program, const Parameter& input, const StreamAccess& access,
                      const std::string& index, std::string_view kind) {
  const auto uniform = [&](std::string_view what) { return parameterUniform(program, "ivec4", what, input); };
  std::string own = index;
  if (access.fitted) {
    const std::string ratio = uniform("ratio");
    own = fmt::format("{} / max({}, 1) * max(-{}, 1)", index, ratio, ratio);
  } else if (access.addressing != Addressing::Aligned) {
    own = fmt::format("min({}, {} - 1)", index, uniform("shape"));
  }
  defineGetter(program, kind, input, own);
}

void definePlacedGetters(ProgramText& program, const Parameter& input, const std::string& index) {
  const auto whole = [&] { return parameterUniform(program, "ivec4", "whole", input); };
  if (input.usesIndex) defineGetter(program, "index", input, fmt::format("min({}, {} - 1)", index, whole()));
  if (input.usesExtent) defineGetter(program, "extent", input, whole());
}

Texel inputTexel(ProgramText& program, const Parameter& input, const StreamAccess& access,
                 std::string_view kind) {
  const std::string index = fmt::format("sk_{}_{}()", kind, input.symbol);
  if (access.strided) {
    const std::string stride = parameterUniform(program, "ivec4", "stride", input);
    if (access.addressing == Addressing::Plane) return stridedTexel(program, input, access, index + ".xy");
    program.require(Function::Ravel);
    return stridedTexel(program, input, access, fmt::format("sk_ravel({}, {})", index, stride));
  }
  const std::string origin =
      access.view ? " + " + parameterUniform(program, "ivec4", "origin", input) : std::string();
  if (access.addressing == Addressing::Plane) {
    return {access.view ? fmt::format("{}.xy{}.xy", index, origin) : index + ".xy", "", access.packed};
  }
  program.require(Function::Ravel);
  program.require(Function::Texel);
  const std::string stride = parameterUniform(program, "ivec4", "stride", input);
  const std::string shift = parameterUniform(program, "int", "shift", input);
  return {fmt::format("sk_texel(sk_ravel({}{}, {}), {}{})", index, origin, stride, shift,
                      access.packed ? " + 2" : ""),
          access.addressing == Addressing::Layered ? shift : "", access.packed};
}

Texel stridedTexel(ProgramText& program, const Parameter& parameter, const StreamAccess& access,
                   const std::string& distance) {
  const std::string origin = parameterUniform(program, "ivec4", "origin", parameter);
  if (access.addressing == Addressing::Plane) {
    const std::string stride = parameterUniform(program, "ivec4", "stride", parameter);
    return {fmt::format("{}.xy + {} * {}.xy", origin, distance, stride), "", access.packed};
  }
  const std::string shift = parameterUniform(program, "int", "shift", parameter);
  const std::string number = fmt::format("{}.x + {}", origin, distance);
  if (access.addressing == Addressing::Rows) {
    program.require(Function::Divide);
    program.require(Function::Row);
    return {fmt::format("sk_in_row({}, {})", number, shift), "", access.packed};
  }
  program.require(Function::Texel);
  return {fmt::format("sk_texel({}, {}{})", number, shift, access.packed ? " + 2" : ""),
          access.addressing == Addressing::Layered ? shift : "", access.packed};
}

std::string iteratorValue(ProgramText& program, const Parameter& iterator, const StreamAccess& access,
                          std::string index) {
  static constexpr std::array<std::string_view, 4> swizzles = {".x", ".xy", ".xyz", ""};
  const std::string_view type = iterator.element->glsl;
  if (access.addressing == Addressing::Linear) {
    program.require(Function::Ravel);
    index = fmt::format("sk_ravel({}, {})", index, parameterUniform(program, "ivec4", "stride", iterator));
  } else {
    index += swizzles[iterator.element->fields.front().width - 1u];
  }
  const int width = iterator.element->fields.front().width;
  const bool isFloat = iterator.element->fields.front().scalar == program::Scalar::Float;
  const bool isSplat = width > 1 && access.addressing == Addressing::Linear;
  if (isFloat && isSplat) index = fmt::format("ivec{}({})", width, index);
  const std::string begin = parameterUniform(program, type, "begin", iterator);
  const std::string step = parameterUniform(program, type, "step", iterator);
  if (!isFloat) return fmt::format("{} + {}({}) * {}", begin, type, index, step);
  program.require(Function::Ramp);
  return fmt::format("sk_ramp({}, {}, {})", begin, index, step);
}

std::string specConstant(ProgramText& program, const Parameter& parameter, std::uint32_t bits) {
  const std::string name = fmt::format("sk_spec_{}", parameter.symbol);
  const program::Scalar scalar = parameter.element->fields.front().scalar;
  program.variable(fmt::format("const {}", parameter.element->glsl),
                   fmt::format("{} = {}", name, glslLiteral(scalar, bits)));
  // compilers know it, and it may be 0
  return scalar == program::Scalar::Float
             ? fmt::format("{}{}{}", program::mark::known, name, program::mark::knownEnd)
             : name;
}

void defineAbsent(ProgramText& program, const Parameter& parameter) {
  const std::string_view type = parameter.element->glsl;
  const std::string none = absentElement(parameter);
  if (parameter.role == program::Role::Gather) {
    const std::string vector = parameter.rank == 1 ? "int" : fmt::format("ivec{}", parameter.rank);
    const std::vector<std::string> nothing = {fmt::format("{} {};", type, none),
                                              fmt::format("return {};", none)};
    if (parameter.usesAt) {
      program.function(fmt::format("{} sk_at_{}({} sk_i)", type, parameter.symbol, vector), nothing);
    }
    if (parameter.usesNear) {
      program.function(fmt::format("{} sk_near_{}({} sk_d)", type, parameter.symbol, vector), nothing);
    }
    if (parameter.usesSample) {
      const std::string floats = parameter.rank == 1 ? "float" : fmt::format("vec{}", parameter.rank);
      program.function(fmt::format("{} sk_sample_{}({} sk_x)", type, parameter.symbol, floats), nothing);
    }
  } else {
    program.statement(fmt::format("{} {};", type, none));
  }
  if (parameter.role == program::Role::Output) return;  // outputs have the domain's index and shape
  if (parameter.usesIndex) defineGetter(program, "index", parameter, "ivec4(0)");
  if (parameter.usesExtent) defineGetter(program, "extent", parameter, "ivec4(0)");
}

std::string absentElement(const Parameter& parameter) { return fmt::format("sk_none_{}", parameter.symbol); }

}  // namespace sk::assemble
