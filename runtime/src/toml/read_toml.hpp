// SPDX-License-Identifier: MIT
//
// Reads TOML files from untrusted sources. Some files crash toml++ (3.3) itself: it destroys tables by
// recursion, so that a key of many thousand parts overflows the stack, and it aborts on a header like [[[a]]]
// (without assertions, it assumes that there is none). Include this header in place of toml++'s.
#pragma once

#include <string>

// toml++ is compiled in read_toml.cpp.
#define TOML_HEADER_ONLY 0
// Some files violate its assertions about the next character; the parser then reports them anyway.
#define TOML_ASSERT(condition) static_assert(true)
#define TOML_MAX_NESTED_VALUES 64
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace sk {

/// Reads a file. Throws toml::parse_error; it has no line if the file cannot be read or is larger than 16
/// MiB.
toml::table readToml(const std::string& file);

}  // namespace sk
