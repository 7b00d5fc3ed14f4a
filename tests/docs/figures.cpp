// SPDX-License-Identifier: MIT
//
// docs_figures RESULTS.json README.md: puts what `./dev bench --json RESULTS.json` measured between the
// marks <!-- figures --> and <!-- /figures -->. The rest of the file stays as it is.
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace {

constexpr const char* first = "<!-- figures -->\n";
constexpr const char* last = "<!-- /figures -->";

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("cannot read '{}'", path));
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string table(const nlohmann::json& results) {
  std::string text =
      fmt::format("| on {} | median | bar |\n|---|---|---|\n", results.at("device").get<std::string>());
  for (const nlohmann::json& row : results.at("results")) {
    const std::string unit = row.at("unit");
    const auto figure = [&](const nlohmann::json& value) {
      return fmt::format("{:.3g} {}", value.get<double>(), unit);
    };
    text += fmt::format("| {} | {} | {} |\n", row.at("name").get<std::string>(), figure(row.at("median")),
                        row.contains("bar") ? figure(row.at("bar")) : "");
  }
  return text;
}

void update(const std::string& results, const std::string& document) {
  const std::string text = read(document);
  const std::size_t begin = text.find(first);
  const std::size_t end = text.find(last);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw std::runtime_error(fmt::format("'{}' has no {} and {}", document, std::string(first, 16), last));
  }
  std::ofstream out(document, std::ios::binary);
  out << text.substr(0, begin) << first << table(nlohmann::json::parse(read(results))) << text.substr(end);
  if (!out.flush()) throw std::runtime_error(fmt::format("cannot write '{}'", document));
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: docs_figures RESULTS.json README.md");
  update(argv[1], argv[2]);
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "docs_figures: {}\n", error.what());
  return 1;
}
