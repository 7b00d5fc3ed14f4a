// SPDX-License-Identifier: MIT
//
// Formats the information about a device as a table for people.
#pragma once

#include <string>
#include <string_view>

#include "info/device_info.hpp"

namespace sk_tool {

/// Of the entries; another one makes what was kept worthless.
inline constexpr int infoSchema = 2;

/// Several lines. Throws Json::exception where an entry is missing or not what it should be.
std::string report(const Json& info);

/// What an earlier run has kept; null where it cannot be reported.
Json readKept(std::string_view text);

}  // namespace sk_tool
