// SPDX-License-Identifier: MIT
//
// Rows of tables by their names.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace linear {

/// The row of a table whose `name` this is. Throws std::runtime_error, "no WHAT is called 'NAME'; there are A, B".
template <class Row>
const Row& rowNamed(std::span<const Row> table, std::string_view name, std::string_view what) {
  std::string names;
  for (const Row& row : table) {
    if (row.name == name) return row;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  }
  throw std::runtime_error(fmt::format("no {} is called '{}'; there are {}", what, name, names));
}

}  // namespace linear
