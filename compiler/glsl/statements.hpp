// SPDX-License-Identifier: MIT
//
// Prints IR statements and functions as GLSL, laid out like the .sk file.
#pragma once

#include "glsl/expressions.hpp"
#include "glsl/line_writer.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// "float blur(float x, inout vec2 y)".
std::string glslHead(const GlslContext& context, ir::FunctionId id);

/// Writes the definition of a function, preceded by a #line directive.
void writeFunction(const GlslContext& context, ir::FunctionId id, LineWriter& writer);

}  // namespace skc::emit
