// SPDX-License-Identifier: MIT
//
// What runtime/web runs, and what it does not.
#pragma once

#include <string>

#include "assemble/assemble.hpp"
#include "program/descriptors.hpp"

namespace skc::web {

/// The profile of programs for browsers. Functions with tables are computed.
sk::assemble::Profile webProfile();

/// The plan of a kernel that needs several passes; null if one is enough, or if it has no plan.
const sk::program::Plan* planOf(const sk::program::Kernel& kernel);

/// Whether a kernel has variable or scatter outputs.
bool hasAppendOutputs(const sk::program::Kernel& kernel);
/// Whether a kernel has too many planes for one pass, and no plan either.
bool isTooLarge(const sk::program::Kernel& kernel);

/// Why WebGL refuses the structs of a kernel, and what to do instead; "" if it takes them.
std::string whyNestsTooDeep(const ir::Module& module, const ir::Kernel& kernel);

/// Why a kernel or reduction cannot be called from a browser, and what to do instead; "" if it can.
std::string whyNotOffered(const ir::Module& module, const emit::Unit& unit);

}  // namespace skc::web
