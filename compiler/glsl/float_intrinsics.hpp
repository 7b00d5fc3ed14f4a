// SPDX-License-Identifier: MIT
//
// Intrinsics that bodies leave to the assembler, which defines them as a call asks: accurately, or by the
// device's own functions; of doubles, those that GLSL does not have.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

/// What the runtime calls an intrinsic on these arguments; nothing where GLSL's own function is meant.
std::optional<sk::program::Intrinsic> definedIntrinsic(const ir::IntrinsicCall& call);

/// Likewise of doubles; nothing for what double_functions.def has.
std::optional<sk::program::Intrinsic> definedOfDoubles(ir::Intrinsic intrinsic);

/// "Sin".
std::string_view enumerator(sk::program::Intrinsic intrinsic);
/// "sk_sin".
std::string functionName(sk::program::Intrinsic intrinsic);

}  // namespace skc::emit
