// SPDX-License-Identifier: MIT
//
// Literals of C++.
#pragma once

#include <string>
#include <string_view>

namespace skc::emit {

/// Text of many lines as raw string literals, broken after lines: compilers limit the length of one, and those that stand
/// side by side are one string.
std::string rawString(std::string_view text);

/// A path or a sentence as a string literal.
std::string quoted(std::string_view text);

/// A float, with all its digits.
std::string floatLiteral(float value);

}  // namespace skc::emit
