// SPDX-License-Identifier: MIT
//
// What the first comment of a reduction's program calls its walk and its runs.
#pragma once

#include <string_view>

#include "assemble/reduce/reduce_program.hpp"

namespace sk::assemble {

std::string_view nameOf(Walk walk);
std::string_view nameOf(Runs runs);

}  // namespace sk::assemble
