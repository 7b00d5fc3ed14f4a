// SPDX-License-Identifier: MIT
//
// What --emit=plan prints: for each kernel the passes that it takes within a profile's limits, what each
// reads and writes, and why values are saved or computed again. Whole programs are glsl_listing's.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"

namespace skc::driver {

/// The module is through all transforms; `name` is that of a profile or of a device, whose limits these are.
std::string planListing(const ir::Module& module, std::string_view name, const ir::Limits& limits);

}  // namespace skc::driver
