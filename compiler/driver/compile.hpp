// SPDX-License-Identifier: MIT
//
// One .sk file through all phases, in the order that compile() shows.
#pragma once

#include <string>

#include "driver/options.hpp"

namespace skc::driver {

/// Exit status: 0, or 1 after errors, which are on standard error by then.
int compile(const Options& options, const std::string& file);

}  // namespace skc::driver
