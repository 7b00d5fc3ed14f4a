// SPDX-License-Identifier: MIT
//
// Prints C++ literals.
#pragma once

#include <string>
#include <string_view>

namespace skc::emit {

/// Multi-line text as adjacent raw string literals, divided between lines: compilers limit the length of one
/// literal, and adjacent literals form one string.
std::string rawString(std::string_view text);

/// A path or a sentence as a quoted string literal.
std::string quoted(std::string_view text);

/// A float literal that keeps the exact value.
std::string floatLiteral(float value);

/// A double literal that keeps the exact value, which is finite.
std::string doubleLiteral(double value);

}  // namespace skc::emit
