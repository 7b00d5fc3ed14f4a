// SPDX-License-Identifier: MIT
//
// What runtime/web runs, and what it does not.
#pragma once

#include <string>

#include "assemble/assemble.hpp"
#include "program/descriptors.hpp"

namespace skc::web {

/// The profile of programs for browsers. Functions with tables are computed.
sk::assemble::Profile webProfile();

/// Why a kernel or reduction cannot be called from a browser, and what to do instead; "" if it can.
std::string whyNotOffered(const emit::Unit& unit);

}  // namespace skc::web
