// SPDX-License-Identifier: MIT
//
// The size of a value: nested arrays multiply.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc::ir {

/// The number of scalars that a value of the type holds.
std::uint64_t numbersIn(const Module& module, Type type);

}  // namespace skc::ir
