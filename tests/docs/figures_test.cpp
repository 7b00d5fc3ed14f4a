// SPDX-License-Identifier: MIT
//
// The measured figures of README.md and docs/performance.md: the tables are there and every row has its figures. Whether
// they are good enough is `./dev bench`'s business.
#include <regex>

#include <catch2/catch.hpp>

#include "excerpts.hpp"
#include "markdown.hpp"

TEST_CASE("README.md has a table of measured figures", "[figures]") {
  const std::string text = docs::readFile(std::filesystem::path(SK_DOCS_SOURCE) / "README.md");
  const std::size_t begin = text.find("<!-- figures -->");
  const std::size_t end = text.find("<!-- /figures -->");
  REQUIRE(begin != std::string::npos);
  REQUIRE(end != std::string::npos);
  REQUIRE(begin < end);
  static const std::regex row(R"(\| [^|]+ \| \d[\d.]* (x|us|ms|s) \| \d[\d.]* (x|us|ms|s) \|)");
  int rows = 0;
  for (const std::string& line : docs::linesOf(text.substr(begin, end - begin))) {
    if (!line.starts_with("| ") || line.starts_with("| on ")) continue;
    INFO(line);
    CHECK(std::regex_match(line, row));
    ++rows;
  }
  CHECK(rows >= 3);
}

namespace {

/// The rows of the table between the marks of this name, without its head; every table of docs/performance.md has one.
std::vector<std::string> rowsOf(const std::string& text, const std::string& name) {
  const std::string mark = "<!-- bench " + name + " -->\n";
  const std::size_t begin = text.find(mark);
  const std::size_t end = text.find("<!-- /bench -->", begin);
  INFO(mark);
  REQUIRE(begin != std::string::npos);
  REQUIRE(end != std::string::npos);
  const std::vector<std::string> lines =
      docs::linesOf(text.substr(begin + mark.size(), end - begin - mark.size()));
  std::vector<std::string> rows;
  for (const std::string& line : lines) {
    if (line.starts_with("| ")) rows.push_back(line);
  }
  REQUIRE(rows.size() > 1);
  rows.erase(rows.begin());
  return rows;
}

}  // namespace

TEST_CASE("README.md shows rows of docs/performance.md as they stand there", "[figures]") {
  const std::string readme = docs::readFile(std::filesystem::path(SK_DOCS_SOURCE) / "README.md");
  const std::string source =
      docs::readFile(std::filesystem::path(SK_DOCS_SOURCE) / "docs" / "performance.md");
  CHECK(readme.find("<!-- excerpt ") != std::string::npos);
  CHECK(docs::withExcerpts(readme, source) == readme);
}

TEST_CASE("README.md's errors of sums stand in docs/accuracy.md", "[figures]") {
  const docs::Document readme = docs::readDocument(SK_DOCS_SOURCE, "README.md");
  const std::string accuracy = docs::readFile(std::filesystem::path(SK_DOCS_SOURCE) / "docs" / "accuracy.md");
  const std::size_t table =
      accuracy.find("\nsum, illconditioned: 4194304 numbers that cancel but for 10^-12");
  REQUIRE(table != std::string::npos);
  const std::string measured = accuracy.substr(table, accuracy.find("```", table) - table);
  static const std::regex row(R"(\| (tree|compensated|exact) \| ([\d.]+) \| ([\d.e+-]+) \|)");
  int rows = 0;
  for (const docs::Piece& piece : readme.rows) {
    std::smatch cells;
    if (!std::regex_match(piece.text, cells, row)) continue;
    INFO(piece.text);
    const std::string error = std::regex_replace(cells[3].str(), std::regex(R"(\+)"), R"(\+)");
    const std::string line = cells[1].str() + " +" + cells[2].str() + R"( \[[\d. ]+\] +)" + error + " ";
    CHECK(std::regex_search(measured, std::regex("\n  " + line)));
    ++rows;
  }
  CHECK(rows == 3);
}

TEST_CASE("docs/performance.md has tables of what was measured", "[figures]") {
  const std::string text = docs::readFile(std::filesystem::path(SK_DOCS_SOURCE) / "docs" / "performance.md");
  // Program, size, time, rate, and a peer's ratio with its quartiles where that took part.
  static const std::regex program(
      R"(\| [^|]+ \| 2\^\d+ [^|]+ \| \d[\d.e+]* (s|ms|us) \| \d[\d.e+-]* \w+/s \|( (\d[\d.]* \(\d[\d.]*-\d[\d.]*\))? \|)*)");
  for (const char* table : {"native", "fragment", "compute"}) {
    for (const std::string& row : rowsOf(text, table)) {
      INFO(row);
      CHECK(std::regex_match(row, program));
    }
  }
  // Call, perhaps the elements of a stream, and a figure for each device.
  static const std::regex cost(R"(\| [^|]+ \|( \d+ x \d+ \|)?( \d[\d.e+-]* \|)+)");
  for (const char* table : {"views", "h100 views", "h100 loops"}) {
    for (const std::string& row : rowsOf(text, table)) {
      INFO(row);
      CHECK(std::regex_match(row, cost));
    }
  }
  // What, how much, what was measured, whether it holds.
  static const std::regex bar(R"(\| [^|]+ \| [^|]+ \| (\S[^|]* \| (yes|NO)|not measured \| ) \|)");
  for (const std::string& row : rowsOf(text, "bars")) {
    INFO(row);
    CHECK(std::regex_match(row, bar));
  }
}
