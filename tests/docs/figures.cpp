// SPDX-License-Identifier: MIT
//
// docs_figures RESULTS.json README.md PERFORMANCE.md: writes what `./dev bench --json RESULTS.json` measured between the
// marks <!-- figures WORD... --> and <!-- /figures -->, the rows that begin with one of the words, and the excerpts of
// the tables of docs/performance.md (excerpts.hpp). The rest of the file stays as it is.
#include <exception>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "excerpts.hpp"

namespace {

constexpr std::string_view first = "<!-- figures ";
constexpr std::string_view behindWords = " -->\n";
constexpr std::string_view last = "<!-- /figures -->";

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("cannot read '{}'", path));
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The text up to the first space.
std::string firstWord(const std::string& text) { return text.substr(0, text.find(' ')); }

std::string table(const nlohmann::json& results, const std::set<std::string>& words) {
  std::string text =
      fmt::format("| on {} | median | bar |\n|---|---|---|\n", results.at("device").get<std::string>());
  for (const nlohmann::json& row : results.at("results")) {
    if (!words.contains(firstWord(row.at("name")))) continue;
    const std::string unit = row.at("unit");
    const auto figure = [&](const nlohmann::json& value) {
      const double rounded = std::stod(fmt::format("{:.3g}", value.get<double>()));
      return fmt::format("{:g} {}", rounded, unit);  // 3190, not 3.19e+03
    };
    text += fmt::format("| {} | {} | {} |\n", row.at("name").get<std::string>(), figure(row.at("median")),
                        row.contains("bar") ? figure(row.at("bar")) : "");
  }
  return text;
}

void update(const std::string& results, const std::string& document, const std::string& performance) {
  const std::string text = read(document);
  const std::size_t begin = text.find(first);
  const std::size_t behind = text.find(behindWords, begin);
  const std::size_t end = text.find(last);
  if (begin == std::string::npos || behind == std::string::npos || end == std::string::npos || end < behind) {
    throw std::runtime_error(fmt::format("'{}' has no {}WORD...{} and {}", document, first,
                                         behindWords.substr(0, behindWords.size() - 1), last));
  }
  const std::size_t rows = behind + behindWords.size();
  std::istringstream listed(text.substr(begin + first.size(), behind - begin - first.size()));
  const std::set<std::string> words{std::istream_iterator<std::string>(listed), {}};
  const std::string figures =
      text.substr(0, rows) + table(nlohmann::json::parse(read(results)), words) + text.substr(end);
  const std::string updated = docs::withExcerpts(figures, read(performance));
  std::ofstream out(document, std::ios::binary);
  out << updated;
  if (!out.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", document));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) throw std::runtime_error("usage: docs_figures RESULTS.json README.md docs/performance.md");
  update(argv[1], argv[2], argv[3]);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "docs_figures: {}\n", error.what());
  return 1;
}
