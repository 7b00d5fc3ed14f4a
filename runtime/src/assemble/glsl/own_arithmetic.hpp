// SPDX-License-Identifier: MIT
//
// The arithmetic of a kernel's body: replaces the marks of sk/arithmetic_marks.hpp.
//
//   $pfloat s = $(a * $[b + c$]$);
//   float s = a * (b + c);                           as the driver likes
//   precise float s = a * (b + c);                   with GLSL's `precise`
//   float s = sk_keep(a * sk_keep(b + c));           with a uniform that is 0
//
// sk_keep() hides what an operation gives by x ^ 0, sk_known() what goes into one by x + 0, of the bits: the second ^ around a
// value would take the first one back.
//
// Floats that must be computed exactly as written have the same barrier. GLSL compilers reorder and remove float operations, and
// regard an addition's rounding error as 0. A barrier stops them: a variable declared `sk_precise`, whose
// value went through sk_keep(), is computed with GLSL's `precise` if available, else its bits change by a
// uniform that is 0, which compilers cannot know.
#pragma once

#include <string>
#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// The barrier of the kernel's own operations: the profile's, or none if the call allows contraction.
Barrier barrierOfBodies(const Profile& profile);

/// The body, or another text with marks, as GLSL.
std::string bodyText(const Profile& profile, std::string_view body);

/// The body without marks.
std::string unmarked(std::string_view body);

/// True if `text`, a result of bodyText(), has operations with a barrier, for which the program must define what
/// exactDefinitions() does.
bool guardsOperations(const Profile& profile, std::string_view text);

/// Defines sk_exact_fraction() if `text`, a result of bodyText(), calls it.
std::string fractionDefinitions(std::string_view text);

/// Declares the variables and functions that `text`, a result of bodyText(), uses and exactDefinitions() does not define.
std::string bodyDefinitions(const Profile& profile, std::string_view text);

/// The #extension line at the beginning of a program that has such floats; ends its line.
std::string_view exactExtensions(const Profile& profile);
/// Defines sk_precise, and sk_keep() for float, vec2, vec3 and vec4.
std::string_view exactDefinitions(Barrier barrier);

}  // namespace sk::assemble
