// SPDX-License-Identifier: MIT
//
// Statements and functions of the IR as GLSL, laid out like the .sk file.
#pragma once

#include "glsl/expressions.hpp"
#include "glsl/line_writer.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// "float blur(float x, inout vec2 y)".
std::string glslHead(const GlslContext& context, ir::FunctionId id);

/// The definition of a function, with a #line directive in front of it.
void writeFunction(const GlslContext& context, ir::FunctionId id, LineWriter& writer);

}  // namespace skc::emit
