// SPDX-License-Identifier: MIT
//
// The texts of this folder's .sk files, which CMake puts into skc.
#pragma once

#include <string_view>

namespace skc::native {

/// float_functions.sk
std::string_view floatFunctions();
/// exact_sums.sk
std::string_view exactSums();

}  // namespace skc::native
