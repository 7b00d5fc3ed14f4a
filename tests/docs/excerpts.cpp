// SPDX-License-Identifier: MIT
#include "excerpts.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace docs {
namespace {

using Row = std::vector<std::string>;

std::string trimmedCell(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(' ') + 1 - begin);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) parts.push_back(trimmedCell(part));
  return parts;
}

/// The text between a mark and the next end mark.
std::string between(const std::string& text, const std::string& mark, std::string_view end) {
  const std::size_t begin = text.find(mark);
  const std::size_t last = text.find(end, begin);
  if (begin == std::string::npos || last == std::string::npos) {
    throw std::runtime_error(fmt::format("there is no table {}", mark));
  }
  return text.substr(begin + mark.size(), last - begin - mark.size());
}

/// The rows of a table of Markdown, its head first.
std::vector<Row> rowsOf(const std::string& table) {
  std::vector<Row> rows;
  std::istringstream in(table);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("| ")) rows.push_back(split(line.substr(1), '|'));
  }
  return rows;
}

std::string lineOf(const Row& row, const std::vector<std::size_t>& columns) {
  std::string line = "|";
  for (const std::size_t column : columns)
    line += fmt::format(" {} |", column < row.size() ? row[column] : "");
  return line + "\n";
}

/// `choice` is what stands in the mark: TABLE: ROW, ...; COLUMN, ...
std::string excerpt(const std::string& choice, const std::string& source) {
  const std::size_t colon = choice.find(": ");
  const std::size_t semicolon = choice.find("; ");
  if (colon == std::string::npos || semicolon == std::string::npos || semicolon < colon) {
    throw std::runtime_error(fmt::format("'{}' is not of the form TABLE: ROW, ...; COLUMN, ...", choice));
  }
  const std::string name = choice.substr(0, colon);
  const std::vector<Row> table =
      rowsOf(between(source, fmt::format("<!-- bench {} -->\n", name), "<!-- /bench -->"));
  if (table.empty()) throw std::runtime_error(fmt::format("table '{}' is empty", name));

  std::vector<std::size_t> columns;
  for (const std::string& column : split(choice.substr(semicolon + 2), ',')) {
    const auto at = std::ranges::find(table.front(), column);
    if (at == table.front().end())
      throw std::runtime_error(fmt::format("'{}' has no column '{}'", name, column));
    columns.push_back(static_cast<std::size_t>(at - table.front().begin()));
  }
  std::string text = lineOf(table.front(), columns) + "|";
  for (std::size_t i = 0; i < columns.size(); ++i) text += "---|";
  text += "\n";
  for (const std::string& wanted : split(choice.substr(colon + 2, semicolon - colon - 2), ',')) {
    const auto row = std::ranges::find_if(table, [&](const Row& one) { return one.front() == wanted; });
    if (row == table.end()) throw std::runtime_error(fmt::format("'{}' has no row '{}'", name, wanted));
    text += lineOf(*row, columns);
  }
  return text;
}

}  // namespace

std::string withExcerpts(const std::string& text, const std::string& source) {
  static constexpr std::string_view mark = "<!-- excerpt ", end = "<!-- /excerpt -->";
  std::string result;
  std::size_t done = 0;
  for (std::size_t begin = text.find(mark); begin != std::string::npos; begin = text.find(mark, done)) {
    const std::size_t behind = text.find(" -->\n", begin);
    const std::size_t last = text.find(end, begin);
    if (behind == std::string::npos || last == std::string::npos || last < behind) {
      throw std::runtime_error(fmt::format("an excerpt does not end with {}", end));
    }
    const std::size_t rows = behind + 5;
    result += text.substr(done, rows - done);
    result += excerpt(text.substr(begin + mark.size(), behind - begin - mark.size()), source);
    done = last;
  }
  return result + text.substr(done);
}

}  // namespace docs
