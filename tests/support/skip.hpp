// SPDX-License-Identifier: MIT
//
// What a test prints where it cannot run. `./dev test` lists these lines of CTest's log at its end.
#pragma once

#include <iostream>
#include <string_view>

/// Reports that this test case, or the rest of it, is left out, and why.
inline void skip(std::string_view why) { std::cout << "skipped: " << why << std::endl; }
