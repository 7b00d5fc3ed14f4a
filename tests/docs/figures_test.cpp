// SPDX-License-Identifier: MIT
//
// The measured figures of README.md: the table is there and every row has a figure with its unit. Whether
// they are fast enough is `./dev bench --check`'s business.
#include <regex>

#include <catch2/catch.hpp>

#include "markdown.hpp"

TEST_CASE("README.md has a table of measured figures", "[figures]") {
  const std::string text = docs::readFile(std::filesystem::path(SK_DOCS_SOURCE) / "README.md");
  const std::size_t begin = text.find("<!-- figures ");
  const std::size_t end = text.find("<!-- /figures -->");
  REQUIRE(begin != std::string::npos);
  REQUIRE(end != std::string::npos);
  REQUIRE(begin < end);
  static const std::regex row(R"(\| [^|]+ \| \d[\d.]* (x|us|ms|s) \| (\d[\d.]* (x|us|ms|s)|) ?\|)");
  int rows = 0;
  for (const std::string& line : docs::linesOf(text.substr(begin, end - begin))) {
    if (!line.starts_with("| ") || line.starts_with("| on ")) continue;
    INFO(line);
    CHECK(std::regex_match(line, row));
    ++rows;
  }
  CHECK(rows >= 3);
}
