// SPDX-License-Identifier: MIT
//
// Prints what sk/program.hpp says of a compiled file as JSON, for other languages (docs/json.md). The same data as
// FILE.sk.cpp, without native code.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"

namespace skc::emit {

/// The version of the JSON's schema: raised when a member is removed, renamed, or changes its meaning, but not when one
/// is added.
inline constexpr int jsonSchema = 4;

/// `fileName` is the .sk file's name without directories.
std::string jsonText(const ir::Module& module, const Program& program, std::string_view fileName);

}  // namespace skc::emit
