// SPDX-License-Identifier: MIT
//
// Tables for people: columns as wide as their widest cell, numbers on the right.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace examples {

enum class Align : std::uint8_t { Left, Right };

class Table {
 public:
  explicit Table(std::vector<std::string> heads) : rows_{std::move(heads)} {}

  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  /// The whole table, every line ended. The first column is set to the left, the others to the right.
  std::string text() const;
  /// The same for documents: Markdown, columns as wide as they happen to be. `others` is for all columns but the first.
  std::string markdown(Align others = Align::Left) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace examples
