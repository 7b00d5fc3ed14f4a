// SPDX-License-Identifier: MIT
//
// How large a value is: arrays in structs in arrays multiply.
#pragma once

#include <cstdint>

#include "ir/ir.hpp"

namespace skc::ir {

/// The numbers (or bools) that a value of the type holds.
std::uint64_t numbersIn(const Module& module, Type type);

}  // namespace skc::ir
