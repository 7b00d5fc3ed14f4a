// SPDX-License-Identifier: MIT
#include "accuracy/file/ranges.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace sk_tool {

namespace {

using sk::program::Parameter;

[[noreturn]] void refuse(const std::string& option, const std::string& text, const char* wanted) {
  throw std::runtime_error(fmt::format("{} '{}' says nothing; write {}", option, text, wanted));
}

/// Parses a number, "true" or "false".
std::optional<double> numberIn(const std::string& text) {
  if (text == "true" || text == "false") return text == "true" ? 1 : 0;
  std::size_t read = 0;
  try {
    const double number = std::stod(text, &read);
    return read == text.size() && std::isfinite(number) ? std::optional(number) : std::nullopt;
  } catch (const std::logic_error&) {  // not a number, or out of the range of doubles
    return std::nullopt;
  }
}

bool isNamed(const Parameter& parameter, const ScalarPlace& place, const std::string& name) {
  return name == parameter.name || name == std::string(parameter.name) + place.member;
}

/// The number of scalars of a parameter with that name.
std::size_t scalarsNamed(const Parameter& parameter, const std::string& name) {
  const std::vector<ScalarPlace> places = scalarsOf(*parameter.element);
  return static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [&](const ScalarPlace& place) {
    return isNamed(parameter, place, name);
  }));
}

/// All names that options may use.
std::string namesOf(std::span<const Subject> subjects) {
  std::vector<std::string> names;
  for (const Subject& subject : subjects) {
    for (const Parameter& parameter : subject.parameters()) {
      const std::string name(parameter.name);
      if (!isResult(parameter) && std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
    }
  }
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void Ranges::addRange(const std::string& text) {
  constexpr const char* wanted = "PARAM=LO:HI with numbers LO <= HI";
  const std::size_t equals = text.find('=');
  const std::size_t colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || colon == std::string::npos) refuse("--range", text, wanted);
  const auto low = numberIn(text.substr(equals + 1, colon - equals - 1));
  const auto high = numberIn(text.substr(colon + 1));
  if (!low || !high || *low > *high) refuse("--range", text, wanted);
  byName_[text.substr(0, equals)] = {{*low, *high}};
}

void Ranges::addValues(const std::string& text) {
  constexpr const char* wanted = "PARAM=VALUE, or PARAM=VALUE,VALUE... for a vector, a struct or an array";
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) refuse("--set", text, wanted);
  std::istringstream list(text.substr(equals + 1));
  std::vector<Range> values;
  for (std::string word; std::getline(list, word, ',');) {
    const auto value = numberIn(word);
    if (!value) refuse("--set", text, wanted);
    values.push_back({*value, *value});
  }
  if (values.empty()) refuse("--set", text, wanted);
  byName_[text.substr(0, equals)] = values;
}

void Ranges::check(std::span<const Subject> subjects) const {
  for (const auto& [name, ranges] : byName_) {
    std::size_t scalars = 0;
    for (const Subject& subject : subjects) {
      for (const Parameter& parameter : subject.parameters()) {
        if (isResult(parameter)) continue;
        scalars = std::max(scalars, scalarsNamed(parameter, name));
      }
    }
    if (scalars == 0) {
      throw std::runtime_error(
          fmt::format("there is no parameter '{}' to draw or set; there are {}", name, namesOf(subjects)));
    }
    if (ranges.size() != 1 && ranges.size() != scalars) {
      throw std::runtime_error(
          fmt::format("'{}' has {} scalar(s), but {} values are given; give one for each, or one for all",
                      name, scalars, ranges.size()));
    }
  }
}

std::vector<std::optional<Range>> Ranges::of(const Parameter& parameter) const {
  std::vector<std::optional<Range>> ranges;
  std::map<std::string, std::size_t> next;
  for (const ScalarPlace& place : scalarsOf(*parameter.element)) {
    std::optional<Range> range;
    for (const auto& [name, given] :
         byName_) {  // sorted: a member's name follows that of the whole parameter
      if (!isNamed(parameter, place, name)) continue;
      range = given.size() == 1 ? given.front() : given[std::min(next[name]++, given.size() - 1)];
    }
    ranges.push_back(range);
  }
  return ranges;
}

std::string Ranges::text() const {
  std::string text;
  for (const auto& [name, ranges] : byName_) {
    text += fmt::format("{}{} ", text.empty() ? "" : ", ", name);
    if (ranges.size() == 1 && !ranges.front().isValue()) {
      fmt::format_to(std::back_inserter(text), "in [{:g}, {:g}]", ranges.front().low, ranges.front().high);
      continue;
    }
    text += "= ";
    for (const Range& value : ranges)
      text += fmt::format("{}{:g}", &value == &ranges.front() ? "" : ", ", value.low);
  }
  return text;
}

}  // namespace sk_tool
