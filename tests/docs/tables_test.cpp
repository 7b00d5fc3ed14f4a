// SPDX-License-Identifier: MIT
//
// The tables of facts against the documents that explain them: every diagnostic has its section in
// docs/errors.md, every intrinsic its row in docs/language.md, and nothing else has; docs/accuracy.md has the bounds of
// errors that programs read.
#include <algorithm>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <catch2/catch.hpp>

#include "markdown.hpp"
#include "sk/error_bounds.hpp"

namespace {

struct Row {
  std::string name, text;
};

const std::vector<Row> diagnostics = {
#define SKC_DIAGNOSTIC(Name, severity, text) {#Name, text},
#include "support/diagnostics.def"
#undef SKC_DIAGNOSTIC
};

using Signatures = std::map<std::string, std::set<std::string>>;

std::set<std::string> wordsOf(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

/// Signatures of each spelling, over the rows that share it.
Signatures intrinsics() {
  Signatures found;
  const auto add = [&](const std::string& spelling, const std::string& signatures) {
    if (!spelling.empty()) found[spelling].merge(wordsOf(signatures));
  };
#define SKC_INTRINSIC(Name, spelling, signatures, library, native, glsl, polyfill) add(spelling, signatures);
#include "ir/intrinsics.def"
#undef SKC_INTRINSIC
  return found;
}

const docs::Document& document(const std::string& name) {
  for (const docs::Document& one : docs::documents()) {
    if (one.name == name) return one;
  }
  FAIL("no " << name);
  return docs::documents().front();
}

/// "no version of '%0' takes (%1)" as a regular expression.
std::regex patternOf(const std::string& text) {
  std::string pattern;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 1 < text.size()) {
      pattern += ".*";
      ++i;
    } else {
      if (std::string_view("^$\\.*+?()[]{}|").find(text[i]) != std::string_view::npos) pattern += '\\';
      pattern += text[i];
    }
  }
  return std::regex(pattern);
}

/// `a` `b` in a cell of a table.
std::vector<std::string> codesIn(const std::string& cell) {
  static const std::regex code("`([^`]*)`");
  std::vector<std::string> codes;
  for (std::sregex_iterator it(cell.begin(), cell.end(), code), end; it != end; ++it)
    codes.push_back((*it)[1]);
  return codes;
}

}  // namespace

TEST_CASE("docs/errors.md has a section for every diagnostic, in their order", "[tables]") {
  const docs::Document& errors = document("docs/errors.md");
  std::vector<std::string> sections;
  for (const docs::Heading& heading : errors.headings) {
    if (heading.text == "sk::Error") break;
    if (heading.level == 3) sections.push_back(heading.text);
  }
  for (std::size_t i = 0; i < std::max(sections.size(), diagnostics.size()); ++i) {
    const std::string section = i < sections.size() ? sections[i] : "(none)";
    REQUIRE(section == (i < diagnostics.size() ? diagnostics[i].name : "(none)"));  // the first that differs
  }
}

TEST_CASE("every section of docs/errors.md quotes its message and shows who gets it", "[tables]") {
  const docs::Document& errors = document("docs/errors.md");
  for (const Row& row : diagnostics) {
    INFO(row.name << ": " << row.text);
    const auto isHere = [&](const auto& piece) { return piece.section == row.name; };
    const auto quote = std::find_if(errors.quotes.begin(), errors.quotes.end(), isHere);
    REQUIRE(quote != errors.quotes.end());
    INFO(quote->text);
    CHECK(std::regex_match(quote->text, patternOf(row.text)));
    if (row.name != "FileUnreadable") {  // which no test can make where it runs as root
      CHECK(std::find_if(errors.blocks.begin(), errors.blocks.end(), isHere) != errors.blocks.end());
    }
  }
}

TEST_CASE("docs/language.md lists every intrinsic with its signatures", "[tables]") {
  Signatures listed;
  for (const docs::Piece& row : document("docs/language.md").rows) {
    if (row.section != "Intrinsics") continue;
    const std::size_t second = row.text.find('|', 1);
    const std::size_t third = row.text.find('|', second + 1);
    const std::vector<std::string> signatures = codesIn(row.text.substr(second, third - second));
    for (const std::string& name : codesIn(row.text.substr(0, second))) {
      INFO(name);
      CHECK(listed.emplace(name, std::set<std::string>(signatures.begin(), signatures.end())).second);
    }
  }
  const Signatures there = intrinsics();
  for (const auto& [name, signatures] : there) {
    INFO(name);
    CHECK(listed[name] == signatures);
  }
  for (const auto& [name, signatures] : listed) {
    INFO(name);
    CHECK(there.contains(name));
  }
}

namespace {

/// The cells of a table's row.
std::vector<std::string> cellsOf(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream in(row.substr(row.find('|') + 1));
  for (std::string cell; std::getline(in, cell, '|');) cells.push_back(docs::trimmed(cell));
  return cells;
}

std::string spelled(double number, int digits) {
  std::ostringstream out;
  out.precision(digits);
  out << number;
  return out.str();
}

/// Bounds in the rows of a section of docs/accuracy.md: `column` has one number for each function that the first cell names.
/// Returns how many were compared.
std::size_t compareBounds(const std::vector<const docs::Piece*>& rows, std::size_t column,
                          sk::BoundedType type, sk::BoundedCode code) {
  std::size_t compared = 0;
  for (const docs::Piece* row : rows) {
    const std::vector<std::string> cells = cellsOf(row->text);
    const std::vector<std::string> functions = codesIn(cells.front());
    std::istringstream numbers(cells.at(column));
    const std::vector<std::string> bounds{std::istream_iterator<std::string>(numbers), {}};
    if (bounds.empty() || functions.empty()) continue;
    INFO("docs/accuracy.md:" << row->line << ": " << row->text);
    REQUIRE(bounds.size() == functions.size());
    for (std::size_t i = 0; i < functions.size(); ++i) {
      const sk::ErrorBound* bound = sk::errorBoundOf(functions[i], type, code);
      INFO(functions[i]);
      REQUIRE(bound != nullptr);
      CHECK(bounds[i] == spelled(bound->bound, 6));
      ++compared;
    }
  }
  return compared;
}

/// The rows of the n-th table of a section, without its head.
std::vector<const docs::Piece*> tableIn(const docs::Document& document, const std::string& section,
                                        std::size_t n) {
  std::vector<const docs::Piece*> rows;
  std::size_t table = 0;
  int last = -1;
  for (const docs::Piece& row : document.rows) {
    if (row.section != section) continue;
    if (last >= 0 && row.line > last + 2) ++table;
    last = row.line;
    if (table == n) rows.push_back(&row);
  }
  REQUIRE(rows.size() > 1);
  rows.erase(rows.begin());
  return rows;
}

}  // namespace

TEST_CASE("docs/accuracy.md has the bounds of sk/error_bounds.def", "[tables]") {
  const docs::Document& accuracy = document("docs/accuracy.md");
  using sk::BoundedCode;
  using sk::BoundedType;
  const std::size_t compared =
      compareBounds(tableIn(accuracy, "Intrinsics and defined arithmetic", 0), 1, BoundedType::Float,
                    BoundedCode::Glsl) +
      compareBounds(tableIn(accuracy, "Native functions", 0), 1, BoundedType::Float, BoundedCode::Native) +
      compareBounds(tableIn(accuracy, "Native functions", 1), 1, BoundedType::Double, BoundedCode::Native) +
      compareBounds(tableIn(accuracy, "Functions of doubles", 0), 1, BoundedType::Double, BoundedCode::Glsl) +
      compareBounds(tableIn(accuracy, "Functions of doubles", 0), 2, BoundedType::Pair, BoundedCode::Glsl);
  CHECK(compared == std::size(sk::errorBounds));  // each has its place
}
