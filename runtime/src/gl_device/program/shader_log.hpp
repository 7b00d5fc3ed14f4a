// SPDX-License-Identifier: MIT
//
// Translates a driver's compile log to source files and lines. Some drivers, such as Mesa, report source
// string 0 regardless of #line. So a rejected program is compiled once more with line numbers that encode the
// source, and that log is translated.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sk {

/// The program with each `#line N K` replaced by `#line M`, where M encodes N and K.
std::string withEncodedLines(std::string_view program);

/// The log of such a program with each source location at the start of a line replaced by "FILE:LINE". Source
/// k is sources[k - 1], and source 0 is the assembled program itself. Supports the three notations of
/// drivers: "1:23(5): error", "1(23) : error" and "ERROR: 1:23:".
std::string withSourceNames(std::string_view log, std::span<const std::string_view> sources);

}  // namespace sk
