// SPDX-License-Identifier: MIT
//
// Runs cases with WebGL2 in one Chromium.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "numbers/case.hpp"

namespace fuzz::numbers {

/// The results of a case, as Devices::run gives them, or what it throws.
using BrowserResult = std::variant<std::vector<Values>, std::string>;

/// The results of cases by their places in the list. Throws std::runtime_error if the browser fails.
std::map<std::uint64_t, BrowserResult> runInBrowser(std::span<const Case> cases);

}  // namespace fuzz::numbers
