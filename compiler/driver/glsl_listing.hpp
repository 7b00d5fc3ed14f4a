// SPDX-License-Identifier: MIT
//
// --emit=glsl: prints whole programs as the runtime assembles them, for streams that are all 2-D textures of
// one shape.
#pragma once

#include <string>
#include <string_view>

#include "program/descriptors.hpp"

namespace skc::driver {

/// `precision`: "half", "extended" or "double" for those variants of the kernels; otherwise float. For browsers (webgl2), the
/// programs in single precision that [[variants(views)]] adds come last.
std::string glslListing(const ir::Module& module, std::string_view profile, std::string_view precision);

}  // namespace skc::driver
