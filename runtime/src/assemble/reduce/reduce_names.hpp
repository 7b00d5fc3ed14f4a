// SPDX-License-Identifier: MIT
//
// Names of walks and runs, for the first comment of a reduction's program.
#pragma once

#include <string_view>

#include "assemble/reduce/reduce_program.hpp"

namespace sk::assemble {

std::string_view nameOf(Walk walk);
std::string_view nameOf(Runs runs);

}  // namespace sk::assemble
