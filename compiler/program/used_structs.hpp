// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"

namespace skc::emit {

/// The structs that kernels and streams use, as indices into Module::structs, each after the structs that it contains.
std::vector<std::uint32_t> usedStructs(const ir::Module& module);

/// How deep the types that a kernel computes with nest structs, where GLSL has no doubles of its own: 1 for a struct of
/// numbers and for a double, 2 for a vector of doubles; 0 if there are none.
int structLevels(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::emit
