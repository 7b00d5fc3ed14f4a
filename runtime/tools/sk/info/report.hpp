// SPDX-License-Identifier: MIT
//
// Formats the information about a device as a table for people.
#pragma once

#include <string>
#include <string_view>

#include "info/device_info.hpp"

namespace sk_tool {

/// The version of the entries; cached reports of other versions are ignored.
inline constexpr int infoSchema = 3;

/// Returns several lines. Throws Json::exception if an entry is missing or has an unexpected type.
std::string report(const Json& info);

/// Parses a cached report; null if it is not a valid report.
Json readKept(std::string_view text);

}  // namespace sk_tool
