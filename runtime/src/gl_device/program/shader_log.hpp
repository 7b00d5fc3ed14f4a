// SPDX-License-Identifier: MIT
//
// A driver's compile log in the user's terms: files and their lines. Some drivers (Mesa among them)
// report source string 0 whatever #line says, so that a program which was refused is compiled once
// more with line numbers that tell the source too, and the log of that is translated.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sk {

/// The program with `#line N K` replaced by a line number that has K in it.
std::string withTellingLines(std::string_view program);

/// The log of such a program with each place at the start of a line put as "FILE:LINE"; source k is
/// sources[k - 1], and 0 the assembled program itself. Understands the three ways in which drivers
/// write a place: "1:23(5): error", "1(23) : error" and "ERROR: 1:23:".
std::string withSourceNames(std::string_view log, std::span<const std::string_view> sources);

}  // namespace sk
