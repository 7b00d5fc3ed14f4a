// SPDX-License-Identifier: MIT
//
// Floats that have to stay as they are computed. GLSL's compilers reorder and drop float operations as they like, and
// an addition's error, computed as the text says, is 0 to them. A variable declared `sk_precise`, whose
// value went through sk_keep(), is left alone by compilers that the barrier holds back: GLSL's `precise` where there is
// that, else a change of its bits by a uniform, which is 0, as far as anyone can tell.
#pragma once

#include <string_view>

#include "sk/arithmetic.hpp"

namespace sk::assemble {

/// The #extension line, which stands first in a program that has such floats; ends its line.
std::string_view exactExtensions(Barrier barrier);
/// sk_precise, and sk_keep() of float, vec2, vec3 and vec4.
std::string_view exactDefinitions(Barrier barrier);

}  // namespace sk::assemble
