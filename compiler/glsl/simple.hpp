// SPDX-License-Identifier: MIT
//
// Prints statements that are one expression or declaration in GLSL, alone or in the head of a loop.
#pragma once

#include <optional>
#include <string>

#include "glsl/expressions.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// A statement without blocks, without its semicolon: "x += 1"; nullopt for all others.
std::optional<std::string> simpleText(const GlslContext& context, ir::FunctionId function,
                                      const ir::Stmt& stmt);

/// "for (int i = 0; i < n; ++i)"; nullopt if GLSL does not accept init or step in a head.
std::optional<std::string> forHead(const GlslContext& context, ir::FunctionId function, const ir::Loop& loop);

/// The number of statements from `first` that declare variables of one type on one line of the .sk file.
std::size_t declaratorsFrom(const GlslContext& context, ir::FunctionId function, const ir::Block& block,
                            std::size_t first);
/// Those statements as one declaration: "float a = 1.0, b".
std::string declaratorList(const GlslContext& context, ir::FunctionId function, const ir::Block& block,
                           std::size_t first, std::size_t count);

}  // namespace skc::emit
