// SPDX-License-Identifier: MIT
//
// docs_figures RESULTS.json README.md PERFORMANCE.md: writes what `./dev bench --json RESULTS.json` measured between the
// marks <!-- figures --> and <!-- /figures -->, the rows that have a bar, and the excerpts of
// the tables of docs/performance.md (excerpts.hpp). The rest of the file stays as it is.
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "excerpts.hpp"

namespace {

constexpr std::string_view first = "<!-- figures -->\n";
constexpr std::string_view last = "<!-- /figures -->";

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("cannot read '{}'", path));
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string table(const nlohmann::json& results) {
  std::string text =
      fmt::format("| on {} | median | bar |\n|---|---|---|\n", results.at("device").get<std::string>());
  for (const nlohmann::json& row : results.at("results")) {
    if (!row.contains("bar")) continue;
    const std::string unit = row.at("unit");
    const auto figure = [&](const nlohmann::json& value) {
      const double rounded = std::stod(fmt::format("{:.3g}", value.get<double>()));
      return fmt::format("{:g} {}", rounded, unit);  // 3190, not 3.19e+03
    };
    text += fmt::format("| {} | {} | {} |\n", row.at("name").get<std::string>(), figure(row.at("median")),
                        figure(row.at("bar")));
  }
  return text;
}

void update(const std::string& results, const std::string& document, const std::string& performance) {
  const std::string text = read(document);
  const std::size_t begin = text.find(first);
  const std::size_t end = text.find(last);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw std::runtime_error(fmt::format("'{}' has no <!-- figures --> and {}", document, last));
  }
  const std::string figures =
      text.substr(0, begin + first.size()) + table(nlohmann::json::parse(read(results))) + text.substr(end);
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
