// SPDX-License-Identifier: MIT
//
// Reads TOML files that somebody else may have written. toml++ (3.3) alone can be brought down by one: it destroys tables by
// recursion, which a key of many thousand parts takes beyond the stack, and it ends the program over a header like [[[a]]] (in
// builds without assertions, it assumes that there is none). Include this header in place of toml++'s.
#pragma once

#include <string>

// All of it is compiled in read_toml.cpp.
#define TOML_HEADER_ONLY 0
// What it asserts of the next character of a file is no fact, and where it does not hold, the parser reports it anyway.
#define TOML_ASSERT(condition) static_assert(true)
#define TOML_MAX_NESTED_VALUES 64
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace sk {

/// Reads a file. Throws toml::parse_error, which has no line where the file cannot be read or is larger than 16 MiB.
toml::table readToml(const std::string& file);

}  // namespace sk
