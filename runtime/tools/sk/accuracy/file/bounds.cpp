// SPDX-License-Identifier: MIT
#include "accuracy/file/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "accuracy/child_process.hpp"

namespace sk_tool {

namespace {

/// "m[0].x" of a matrix, as skc writes it: "m[0][0]".
std::string componentFor(const std::string& component) {
  constexpr std::string_view letters = "xyzw";
  if (!component.starts_with('[')) return component;
  const std::size_t column = letters.find(component.back());
  return fmt::format("{}[{}]", component.substr(0, component.find('.')), column);
}

/// The options for skc that say what is drawn.
std::vector<std::string> rangesOf(const Subject& subject, const Ranges& ranges) {
  std::vector<std::string> words;
  for (const sk::program::Parameter& parameter : subject.parameters()) {
    if (isResult(parameter)) continue;
    const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
    const std::vector<std::optional<Range>> given = ranges.of(parameter);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::string name =
          std::string(parameter.name) + places[i].member + componentFor(places[i].component);
      const bool isOne = !given[i] && parameter.role == sk::program::Role::Spec;  // as it is drawn
      if (!given[i] && !isOne) continue;
      const Range range = isOne ? Range{1, 1} : *given[i];
      words.emplace_back("--range");
      words.push_back(fmt::format("{}={}:{}", name, range.low, range.high));
    }
  }
  return words;
}

/// The largest error of any of a kernel's numbers, with what decisions change where rounding turns them. Nullopt if one has no bound.
std::optional<double> largestIn(const Json& kernel) {
  double largest = 0;
  for (const Json& number : kernel.at("numbers")) {
    if (number.contains("not_bounded")) return std::nullopt;
    const auto absolute = number.at("absolute").get<double>();
    double bound = absolute;
    for (const Json& jump : number.at("jumps")) {
      if (jump.at("change").is_null()) return std::nullopt;
      bound += jump.at("change").get<double>() + absolute;
    }
    // The reference's results are doubles.
    const Json& range = number.at("range");
    if (range[0].is_null() || range[1].is_null()) return std::nullopt;
    bound += 0x1p-53 * std::max(std::fabs(range[0].get<double>()), std::fabs(range[1].get<double>()));
    largest = std::max(largest, bound);
  }
  return largest;
}

}  // namespace

/// What skc prints of a kernel; null if it has none, or several of this name.
Json FileBounds::boundsOf(const Subject& subject, const std::string& precision) const {
  const TemporaryFolder folder;
  const std::string output = (folder.path() / "bounds.json").string();
  std::vector<std::string> words = skcWords(options_);
  for (const char* word : {"--emit=bounds", "--json"}) words.emplace_back(word);
  words.push_back("--precision=" + precision);
  words.push_back(std::string("--target=") + (isNative_ ? "native" : "fragment"));
  words.push_back("--kernel=" + subject.name());
  for (std::string& word : rangesOf(subject, ranges_)) words.push_back(std::move(word));
  words.push_back(file_.string());
  if (runProgram(words, Messages::Hidden, output) != 0) return nullptr;
  std::ifstream in(output);
  const Json all = Json::parse(in, nullptr, /*allow_exceptions=*/false);
  if (all.is_discarded() || all.at("kernels").size() != 1) return nullptr;
  return all["kernels"][0];
}

void FileBounds::addTo(Experiment& experiment, const Subject& subject) const {
  if (subject.isReduce()) return;
  for (Row& row : experiment.rows) {
    const bool hasBounds =
        row.mode == "single" || row.mode == "half" || row.mode == "extended" || row.mode == "double";
    if (row.isRefused() || !hasBounds) continue;
    const auto metric = std::ranges::find(row.grade.metrics, "abs err", &Metric::name);
    const Json kernel = boundsOf(subject, row.mode);
    if (kernel.is_null() || kernel.contains("not_bounded")) continue;
    row.grade.bound = largestIn(kernel);
    if (!row.grade.bound || metric == row.grade.metrics.end()) continue;
    row.grade.isWithinBound = metric->value <= *row.grade.bound;
    experiment.bounded = "abs err";
  }
}

}  // namespace sk_tool
