// SPDX-License-Identifier: MIT
//
// Intrinsics that bodies leave to the assembler. It defines them as each call chooses, accurately or by the
// device's own functions; for doubles, it defines those that GLSL lacks.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

/// The runtime's name for an intrinsic with these arguments; nullopt if GLSL's own function serves.
std::optional<sk::program::Intrinsic> definedIntrinsic(const ir::IntrinsicCall& call);

/// The same for doubles; nullopt for the rows of double_functions.def.
std::optional<sk::program::Intrinsic> definedOfDoubles(ir::Intrinsic intrinsic);

/// "Sin".
std::string_view enumerator(sk::program::Intrinsic intrinsic);
/// "sk_sin".
std::string functionName(sk::program::Intrinsic intrinsic);

}  // namespace skc::emit
