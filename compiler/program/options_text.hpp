// SPDX-License-Identifier: MIT
//
// What a kernel's declaration chooses, as C++.
#pragma once

#include <string>

#include "sk/program.hpp"

namespace skc::emit {

/// The initializer of a CallOptions, within sk::program.
std::string optionsText(const sk::CallOptions& options);

}  // namespace skc::emit
