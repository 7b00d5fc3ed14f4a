// SPDX-License-Identifier: MIT
//
// The texts of this folder's .sk files, which CMake embeds in skc.
#pragma once

#include <string_view>

namespace skc::native {

std::string_view floatFunctions();    ///< float_functions.sk
std::string_view doubleFunctions();   ///< double_functions.sk and double_errors.sk
std::string_view exactSums();         ///< exact_sums.sk

}  // namespace skc::native
