// SPDX-License-Identifier: MIT
//
// Floats that must be computed exactly as written. GLSL compilers reorder and remove float operations, and
// regard an addition's rounding error as 0. A barrier stops them: a variable declared `sk_precise`, whose
// value went through sk_keep(), is computed with GLSL's `precise` if available, else its bits change by a
// uniform that is 0, which compilers cannot know.
#pragma once

#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// The #extension line at the beginning of a program that has such floats; ends its line.
std::string_view exactExtensions(const Profile& profile);
/// Defines sk_precise, and sk_keep() for float, vec2, vec3 and vec4.
std::string_view exactDefinitions(Barrier barrier);

}  // namespace sk::assemble
