// SPDX-License-Identifier: MIT
//
// What glslang says of what skc has written, as one finding.
#pragma once

#include <string>
#include <vector>

namespace fuzz {

/// The first complaint about the programs of some listings (skc --emit=glsl), or "".
std::string glslComplaint(const std::vector<std::string>& listings);

}  // namespace fuzz
