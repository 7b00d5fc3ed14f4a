// SPDX-License-Identifier: MIT
//
// Named constants in GLSL. Compilers differ in which functions they fold (glslang does not even fold
// uintBitsToFloat, which infinities need). A constant is therefore `const` only if it calls no function, and
// otherwise a function without parameters, which keeps its name and compiles everywhere.
#pragma once

#include <vector>

#include "glsl/expressions.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// For each constant of a module after legalize, whether it must be a function.
std::vector<bool> functionConstants(const ir::Module& module);

/// "const float pi = 3.1415927;" or "float none() { return uintBitsToFloat(0xff800000u); }", with a newline.
std::string constantText(const GlslContext& context, ir::ConstantId id);

}  // namespace skc::emit
