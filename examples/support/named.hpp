// SPDX-License-Identifier: MIT
//
// Rows of tables by their names.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace examples {

/// The row of a table whose `name` this is. Throws std::runtime_error, "no WHAT is called 'NAME'; there are A, B".
template <class Rows>
const auto& rowNamed(const Rows& table, std::string_view name, std::string_view what) {
  std::string names;
  for (const auto& row : table) {
    if (row.name == name) return row;
    names += fmt::format("{}{}", names.empty() ? "" : ", ", row.name);
  }
  throw std::runtime_error(fmt::format("no {} is called '{}'; there are {}", what, name, names));
}

/// `head`, and a line for each row of a table: its `name` in `width` columns, and what it `does`.
template <class Rows>
std::string listed(std::string head, const Rows& table, std::size_t width) {
  for (const auto& row : table) head += fmt::format("\n  {:<{}} {}", row.name, width, row.does);
  return head;
}

}  // namespace examples
