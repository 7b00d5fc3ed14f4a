// SPDX-License-Identifier: MIT
//
// Rows of tables by the names that users write.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>
#include <sk/error.hpp>

namespace sk::text {

/// The row of a table whose `name` this is. Throws sk::Error, "no WHAT is called 'NAME'; there are A, B".
template <class Rows>
const auto& rowNamed(const Rows& table, std::string_view name, std::string_view what) {
  std::string names;
  for (const auto& row : table) {
    if (row.name == name) return row;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  }
  throw sk::Error(fmt::format("no {} is called '{}'; there are {}", what, name, names));
}

}  // namespace sk::text
