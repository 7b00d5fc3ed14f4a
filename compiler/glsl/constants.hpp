// SPDX-License-Identifier: MIT
//
// Named constants in GLSL. Compilers differ in which functions they fold (glslang not even
// uintBitsToFloat, which infinities need), so a constant is `const` only where it takes none, and
// otherwise a function without parameters: its name stays, and every compiler takes it.
#pragma once

#include <vector>

#include "glsl/expressions.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// For each constant of the module: whether it has to be a function.
std::vector<bool> functionConstants(const ir::Module& module);

/// "const float pi = 3.1415927;" or "float none() { return uintBitsToFloat(0xff800000u); }", and a newline.
std::string constantText(const GlslContext& context, ir::ConstantId id);

}  // namespace skc::emit
