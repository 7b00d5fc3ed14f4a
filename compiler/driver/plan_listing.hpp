// SPDX-License-Identifier: MIT
//
// --emit=plan: prints for each kernel the passes that it needs within a profile's limits, what each pass
// reads and writes, and why values are saved or recomputed. glsl_listing prints whole programs.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"

namespace skc::driver {

/// The module has passed all transforms; `name` is the profile or device that has these limits.
std::string planListing(const ir::Module& module, std::string_view name, const ir::Limits& limits);

}  // namespace skc::driver
