// SPDX-License-Identifier: MIT
//
// Checks the GLSL that skc writes with glslang, and makes one finding of its complaints.
#pragma once

#include <string>
#include <vector>

namespace fuzz {

/// The first complaint about the programs of some listings (skc --emit=glsl), or "".
std::string glslComplaint(const std::vector<std::string>& listings);

}  // namespace fuzz
