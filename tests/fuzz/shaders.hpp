// SPDX-License-Identifier: MIT
//
// Shows GLSL to glslangValidator.
#pragma once

#include <string>
#include <vector>

namespace fuzz {

/// Its complaints about the programs of some listings (skc --emit=glsl), or "".
std::string complaints(const std::vector<std::string>& listings);

}  // namespace fuzz
