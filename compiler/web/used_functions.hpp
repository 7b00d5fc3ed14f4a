// SPDX-License-Identifier: MIT
//
// Removes from a program what its main() does not call: the assembler adds support functions in groups, and every byte of a
// module for browsers is sent and compiled.
//
//   // The square.                            void main() { r = cube(x); }
//   float square(float x) { ... }
//   float cube(float x) { ... }       ->      float cube(float x) { ... }
//   void main() { r = cube(x); }              void main() { r = cube(x); }
#pragma once

#include <string>
#include <string_view>

namespace skc::web {

/// The program without functions that are not used, by main(), by declarations or by `more`, and without comments between
/// functions. It must have no conditional compilation.
std::string withUsedFunctions(std::string_view program, std::string_view more);

}  // namespace skc::web
