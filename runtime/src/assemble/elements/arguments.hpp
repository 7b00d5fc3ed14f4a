// SPDX-License-Identifier: MIT
//
// What main() hands to a kernel's entry function, and what it defines for the body, for parameters that
// are read: the same in programs of kernels and of reductions. `index` is an expression for the index of
// the current element in the domain, an ivec4.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// Declares `sk_KIND_P` of a parameter, and gives its name.
std::string parameterUniform(ProgramText& program, std::string_view type, std::string_view kind,
                             const program::Parameter& parameter);

/// Defines what the body calls as `sk_index_p` or `sk_extent_p`.
void defineGetter(ProgramText& program, std::string_view kind, const program::Parameter& parameter,
                  std::string_view value);

/// Defines sk_extent_p where the body calls it.
void defineExtent(ProgramText& program, const program::Parameter& parameter);

/// Defines sk_index_p of an input, fitted or not. One of extent 1 in a dimension repeats its only element there.
void defineInputIndex(ProgramText& program, const program::Parameter& input, const StreamAccess& access,
                      const std::string& index);

/// The texel of the current element of an input that is not aligned, by its sk_index_p.
Texel inputTexel(ProgramText& program, const program::Parameter& input, const StreamAccess& access);

/// The current value of an iterator: a multiplication and an addition; integers wrap.
std::string iteratorValue(ProgramText& program, const program::Parameter& iterator,
                          const StreamAccess& access, std::string index);

/// Declares the constant for the value of a Spec parameter, and gives its name.
std::string specConstant(ProgramText& program, const program::Parameter& parameter, std::uint32_t bits);

/// Defines what the body names of a stream that the values of spec parameters never let it use.
void defineAbsent(ProgramText& program, const program::Parameter& parameter);
/// The variable that stands for the element of such a stream, which is no gather.
std::string absentElement(const program::Parameter& parameter);

}  // namespace sk::assemble
