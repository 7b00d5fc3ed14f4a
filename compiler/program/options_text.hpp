// SPDX-License-Identifier: MIT
//
// Prints the options that a kernel's attributes choose as C++.
#pragma once

#include <string>

#include "sk/program.hpp"

namespace skc::emit {

/// The initializer of a CallOptions in namespace sk::program.
std::string optionsText(const sk::CallOptions& options);

}  // namespace skc::emit
