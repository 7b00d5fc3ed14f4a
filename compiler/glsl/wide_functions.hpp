// SPDX-License-Identifier: MIT
//
// The functions that compute intrinsics of wide values: polyfills, or functions of the assembler.
#pragma once

#include <vector>

#include "glsl/polyfills.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

/// The function for arguments of these types, whose first one is wide.
ir::FunctionId wideFunction(Polyfills& polyfills, ir::Intrinsic intrinsic,
                            const std::vector<ir::Type>& types);

}  // namespace skc::emit
