// SPDX-License-Identifier: MIT
//
// Functions of the IR as members of a native kernel's struct.
#pragma once

#include <string>

#include "emit/native_expr.hpp"

namespace skc::emit {

/// The function, indented by two spaces.
std::string nativeFunction(const NativeContext& context, ir::FunctionId id);

}  // namespace skc::emit
