// SPDX-License-Identifier: MIT
//
// What is known of a device as a table for people.
#pragma once

#include <string>

#include "info/device_info.hpp"

namespace sk_tool {

/// Several lines. Throws Json::exception where an entry is missing or not what it should be.
std::string report(const Json& info);

}  // namespace sk_tool
