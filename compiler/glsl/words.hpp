// SPDX-License-Identifier: MIT
//
// Names that GLSL and ESSL reserve, in any version that we emit for or that a driver may read the text as.
#pragma once

#include <string>
#include <string_view>

namespace skc::emit {

/// Keywords and reserved words of GLSL 1.10 to 4.60 and ESSL 1.00 to 3.20, and "main".
bool isGlslWord(std::string_view name);

/// Built-in functions of these versions, and other names that compilers reserve. GLSL lets a program redefine
/// them, ESSL does not.
bool isGlslFunction(std::string_view name);

/// Changes what GLSL does not allow in a name: `sample` gives "sample_", `sk_x` "user_sk_x", `a__b` "a_b",
/// letters beyond ASCII their code points.
std::string glslSafe(std::string_view name);

/// The same for a name of global scope, which must not redefine a built-in function: `mix` gives "mix_".
std::string glslSafeGlobal(std::string_view name);

}  // namespace skc::emit
