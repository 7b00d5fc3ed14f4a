// SPDX-License-Identifier: MIT
#include "assemble/glsl/group_sums.hpp"

#include "glsl_text/group_sums.hpp"

namespace sk::assemble {

std::string_view groupSums() { return library::groupSums; }

}  // namespace sk::assemble
