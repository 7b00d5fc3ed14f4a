// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"

namespace skc::emit {

/// The structs that kernels and streams use, as indices into Module::structs, each after the structs that it contains.
std::vector<std::uint32_t> usedStructs(const ir::Module& module);

}  // namespace skc::emit
