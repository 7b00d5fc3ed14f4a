// SPDX-License-Identifier: MIT
//
// Converts literals when they are lowered, because `v = 1` reads better as 1.0 than as float(1).
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace llvm {
class APSInt;
}  // namespace llvm

namespace skc::frontend {

/// The low 64 bits of an integer of any width, with its sign.
std::uint64_t lowBits(const llvm::APSInt& number);

/// The literal of another scalar type that `e`, a scalar literal, becomes; null where the conversion stays in the program.
ir::ExprPtr convertLiteral(const ir::Expr& e, ir::Scalar to);

}  // namespace skc::frontend
