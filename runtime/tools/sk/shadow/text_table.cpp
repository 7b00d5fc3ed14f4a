// SPDX-License-Identifier: MIT
#include "shadow/text_table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace sk_tool {

namespace {

/// The characters of a text in UTF-8.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string TextTable::nameOf(std::size_t column) const {
  const std::string& name = columns_[column];
  return name.starts_with('<') ? name.substr(1) : name;
}

std::string TextTable::text(std::size_t most) const {
  const std::size_t shown = std::min(most, rows_.size());
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    widths.push_back(widthOf(nameOf(c)));
    for (std::size_t r = 0; r < shown; ++r) widths[c] = std::max(widths[c], widthOf(rows_[r][c]));
  }
  std::string all;
  const auto addLine = [&](const auto& cellOf) {
    std::string line;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const std::string cell = cellOf(c);
      const std::string gap(widths[c] - widthOf(cell), ' ');
      line += "  " + (isLeft(c) ? cell + gap : gap + cell);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    all += line + "\n";
  };
  addLine([&](std::size_t c) { return nameOf(c); });
  for (std::size_t r = 0; r < shown; ++r) addLine([&](std::size_t c) { return rows_[r][c]; });
  if (shown < rows_.size()) all += fmt::format("  and {} more; --all shows them\n", rows_.size() - shown);
  return all;
}

}  // namespace sk_tool
