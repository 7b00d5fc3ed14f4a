// SPDX-License-Identifier: MIT
#include "support/table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace examples {

std::string Table::text() const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t i = 0; i < widths.size() && i < row.size(); ++i)
      widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < widths.size() && i < rows_[r].size(); ++i) {
      line += i == 0 ? fmt::format("{:<{}}", rows_[r][i], widths[i])
                     : fmt::format("  {:>{}}", rows_[r][i], widths[i]);
    }
    text += line + "\n";
    if (r == 0) text += std::string(line.size(), '-') + "\n";
  }
  return text;
}

std::string Table::markdown(Align others) const {
  std::string text;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    text += '|';
    for (const std::string& cell : rows_[row]) text += fmt::format(" {} |", cell);
    text += '\n';
    if (row > 0) continue;
    text += '|';
    for (std::size_t i = 0; i < rows_[row].size(); ++i)
      text += i > 0 && others == Align::Right ? "---:|" : "---|";
    text += '\n';
  }
  return text;
}

}  // namespace examples
