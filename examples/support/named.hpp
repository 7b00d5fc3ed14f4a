// SPDX-License-Identifier: MIT
//
// Rows of tables by their names, and as help of command lines shows them.
#pragma once

#include <string>

#include <fmt/format.h>

#include "text/named.hpp"

namespace examples {

using sk::text::rowNamed;

/// `head`, and a line for each row of a table: its `name` in `width` columns, and what it `does`.
template <class Rows>
std::string listed(std::string head, const Rows& table, std::size_t width) {
  for (const auto& row : table) head += fmt::format("\n  {:<{}} {}", row.name, width, row.does);
  return head;
}

}  // namespace examples
