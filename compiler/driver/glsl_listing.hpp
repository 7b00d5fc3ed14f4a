// SPDX-License-Identifier: MIT
//
// --emit=glsl: the whole programs as the runtime assembles them, for streams that all lie as 2-D
// textures of one shape.
#pragma once

#include <string>
#include <string_view>

#include "program/descriptors.hpp"

namespace skc::driver {

/// `precision`: "half", "extended" or "double" for these forms of the kernels; else those that compute in floats.
std::string glslListing(const emit::Program& program, std::string_view profile, std::string_view precision);

}  // namespace skc::driver
