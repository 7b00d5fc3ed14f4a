// SPDX-License-Identifier: MIT
//
// The files of a report: written under a temporary name and renamed, and never in the place of a file that the program has
// written meanwhile.
#pragma once

#include <string>
#include <string_view>

namespace sk::shadow {

/// Identifies a version of a file; empty if there is none.
std::string fileMark(const std::string& file);

/// Replaces a file. Returns what went wrong; empty if nothing did.
std::string replaceFile(const std::string& file, std::string_view text);

/// Another name for a file: report-2.html, the first that does not exist.
std::string otherName(const std::string& file);

}  // namespace sk::shadow
