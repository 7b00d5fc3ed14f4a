// SPDX-License-Identifier: MIT
//
// Tables of text, for terminals.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sk_tool {

/// Columns are as wide as their widest cell. The first stands to the left, all others to the right, unless their names begin with '<'.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> columns) : columns_(std::move(columns)) {}

  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  bool isEmpty() const { return rows_.empty(); }
  /// The head and the first `most` rows, each with two spaces before it, and a line that counts the others.
  std::string text(std::size_t most) const;

 private:
  bool isLeft(std::size_t column) const { return column == 0 || columns_[column].starts_with('<'); }
  std::string nameOf(std::size_t column) const;

  std::vector<std::string> columns_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace sk_tool
