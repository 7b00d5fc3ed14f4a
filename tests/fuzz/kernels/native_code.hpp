// SPDX-License-Identifier: MIT
//
// Compiles a module for this processor, as sk_add_kernels does, and loads the object file into this process.
#pragma once

#include <string>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"

namespace fuzz {

/// The descriptors of a module, with native code for the given level of the CPU (native::levelNames; empty: all). The code
/// stays loaded until the process ends. Throws std::runtime_error if the object file cannot be linked.
skc::emit::Program withNativeCode(const skc::ir::Module& module, const std::string& level);

/// The levels that this processor supports.
std::vector<std::string> supportedLevels();

}  // namespace fuzz
