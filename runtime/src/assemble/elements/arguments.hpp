// SPDX-License-Identifier: MIT
//
// GLSL for parameters that are read: the arguments that main() passes to a kernel's entry function, and the
// definitions that the body needs. Shared by programs of kernels and of reductions. `index` is an ivec4
// expression for the index of the current element in the domain.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// Declares `sk_KIND_P` for a parameter and returns its name.
std::string parameterUniform(ProgramText& program, std::string_view type, std::string_view kind,
                             const program::Parameter& parameter);

/// The value of a uniform: a GLSL uniform, or a variable with an element of a stream.
std::string uniformValue(ProgramText& program, const program::Parameter& uniform, const StreamAccess& access);

/// Defines the function `sk_index_p` or `sk_extent_p` for the body.
void defineGetter(ProgramText& program, std::string_view kind, const program::Parameter& parameter,
                  std::string_view value);

/// Defines sk_extent_p, the uniform sk_KIND_p, if the body calls it.
void defineExtent(ProgramText& program, const program::Parameter& parameter, std::string_view kind = "shape");

/// Defines sk_KIND_p, the index in an input, fitted or not. In a dimension of extent 1, the input is broadcast.
void defineInputIndex(ProgramText& program, const program::Parameter& input, const StreamAccess& access,
                      const std::string& index, std::string_view kind = "index");

/// Defines sk_index_p and sk_extent_p of an input in a placed domain; `index` is the index in the whole.
void definePlacedGetters(ProgramText& program, const program::Parameter& input, const std::string& index);

/// The texel of the current element of an input that is not aligned, from its sk_KIND_p.
Texel inputTexel(ProgramText& program, const program::Parameter& input, const StreamAccess& access,
                 std::string_view kind = "index");

/// The texel of an element of a strided region. `distance` is its index, an ivec2 expression, if the region is
/// addressed as a plane; else sum(index * stride), an int expression.
Texel stridedTexel(ProgramText& program, const program::Parameter& parameter, const StreamAccess& access,
                   const std::string& distance);

/// The current value of an iterator: one multiplication and one addition; integers wrap.
std::string iteratorValue(ProgramText& program, const program::Parameter& iterator,
                          const StreamAccess& access, std::string index);

/// Declares the constant for a Spec parameter's value and returns its name.
std::string specConstant(ProgramText& program, const program::Parameter& parameter, std::uint32_t bits);

/// Defines what the body uses of a stream that the spec parameters' values switch off.
void defineAbsent(ProgramText& program, const program::Parameter& parameter);
/// The variable that replaces the element of such a stream, which is not a gather.
std::string absentElement(const program::Parameter& parameter);

}  // namespace sk::assemble
