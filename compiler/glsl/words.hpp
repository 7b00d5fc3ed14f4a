// SPDX-License-Identifier: MIT
//
// Which names GLSL and ESSL keep for themselves, in any version that we emit for or a driver may
// read the text as.
#pragma once

#include <string>
#include <string_view>

namespace skc::emit {

/// Keywords and reserved words of GLSL 1.10 to 4.60 and ESSL 1.00 to 3.20; "main" too.
bool isGlslWord(std::string_view name);

/// Built-in functions of these versions, and others that compilers keep to themselves. GLSL lets a program define a function of that name, ESSL does not.
bool isGlslFunction(std::string_view name);

/// The name with what GLSL does not allow in it changed: `sample` gives "sample_", `sk_x` "user_sk_x",
/// `a__b` "a_b", letters beyond ASCII their code points.
std::string glslSafe(std::string_view name);

}  // namespace skc::emit
