// SPDX-License-Identifier: MIT
//
// The files of a report: written under a temporary name and renamed, and never in the place of a file that the program has
// written meanwhile.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sk::shadow {

/// Identifies a version of a file; empty if there is none.
std::string fileMark(const std::string& file);

/// Replaces a file. Returns what went wrong; empty if nothing did.
std::string replaceFile(const std::string& file, std::string_view text);

/// Another name for files that differ in their endings: report-2, the first with which none of them exists.
std::string otherName(const std::string& name, const std::vector<std::string>& endings);

}  // namespace sk::shadow
