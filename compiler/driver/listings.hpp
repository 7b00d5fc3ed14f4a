// SPDX-License-Identifier: MIT
//
// What skc prints for people instead of files for a build.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"

namespace skc::driver {

/// --emit=glsl: prints whole programs as the runtime assembles them, for streams that are all 2-D textures of one shape.
/// `precision`: "half", "extended" or "double" for those variants of the kernels; otherwise float. For browsers (webgl2), the
/// programs in single precision that [[variants(views)]] adds come last.
std::string glslListing(const ir::Module& module, std::string_view profile, std::string_view precision);

/// --emit=plan: prints for each kernel the passes that it needs within a profile's limits, what each pass reads and writes, and
/// why values are saved or recomputed.
/// The module has passed all transforms; `name` is the profile or device that has these limits.
std::string planListing(const ir::Module& module, std::string_view name, const ir::Limits& limits);

}  // namespace skc::driver
