// SPDX-License-Identifier: MIT
#include "stress/cases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "shadow/options.hpp"

namespace sk_tool::stress {

namespace {

/// The numbers of a type that are farthest apart.
struct Extremes {
  double smallest;  ///< above 0
  double largest;
  bool isSigned = true;
};

std::optional<Extremes> extremesOf(const std::string& scalar) {
  if (scalar == "float")
    return Extremes{std::numeric_limits<float>::min(), std::numeric_limits<float>::max()};
  if (scalar == "double")
    return Extremes{std::numeric_limits<double>::min(), std::numeric_limits<double>::max()};
  if (scalar == "half") return Extremes{0x1p-14, 65504};
  if (scalar == "snorm") return Extremes{0x1p-15, 1};
  if (scalar == "unorm") return Extremes{0x1p-16, 1, false};
  return std::nullopt;
}

bool isInteger(const Given& given) { return given.scalar == "int" || given.scalar == "uint"; }

/// Parameters that are given the same.
using Group = std::vector<const Given*>;

bool areAlike(const Given& a, const Given& b) {
  return !a.isStream && !b.isStream && a.parameter == b.parameter && a.scalar == b.scalar && a.low == b.low &&
         a.high == b.high && a.range == b.range;
}

std::vector<Group> groupsOf(const std::vector<Given>& given, const std::vector<std::string>& only) {
  std::vector<Group> groups;
  for (const Given& each : given) {
    const bool isWanted = only.empty() || sk::shadow::matchesAny(only, each.kernel) ||
                          sk::shadow::matchesAny(only, fmt::format("{}.{}", each.kernel, each.parameter));
    if (!isWanted) continue;
    const auto alike =
        std::ranges::find_if(groups, [&](const Group& group) { return areAlike(*group.front(), each); });
    if (alike == groups.end()) {
      groups.push_back({&each});
    } else {
      alike->push_back(&each);
    }
  }
  return groups;
}

/// "heat::step.dt", or "dt of heat::step and heat::flux".
std::string nameOf(const Group& group) {
  const Given& first = *group.front();
  if (group.size() == 1) return fmt::format("{}.{}", first.kernel, first.parameter);
  std::vector<std::string> kernels;
  for (const Given* each : group) kernels.push_back(each->kernel);
  constexpr std::size_t most = 3;
  const std::size_t count = kernels.size();
  if (count > most) {
    kernels.resize(most - 1);
    return fmt::format("{} of {} and {} others", first.parameter, fmt::join(kernels, ", "), count - most + 1);
  }
  const std::string last = kernels.back();
  kernels.pop_back();
  return fmt::format("{} of {} and {}", first.parameter, fmt::join(kernels, ", "), last);
}

class Maker {
 public:
  Maker(const Group& group, std::vector<Case>& cases)
      : group_(group), given_(*group.front()), cases_(cases) {}

  void add() {
    if (given_.scalar == "bool") return;
    given_.range ? addRange(*given_.range) : addExtremes();
  }

 private:
  void addRange(const Range& range) {
    const std::optional<Extremes> extremes = extremesOf(given_.scalar);
    const auto within = [&](double value) { return value >= range.low && value <= range.high; };
    const double most = extremes ? extremes->largest : 0x1p30;
    const double low = std::fmax(range.low, -most), high = std::fmin(range.high, most);
    add(low, low == range.low ? "the lower end of its range" : "the least number in its range");
    add(high, high == range.high ? "the upper end of its range" : "the largest number in its range");
    if (range.low < 0 && range.high > 0) add(0, "in its range");
    if (extremes && within(extremes->smallest)) add(extremes->smallest, "tiny, in its range");
  }

  void addExtremes() {
    add(0, {});
    if (isInteger(given_)) return add(1, {});
    const std::optional<Extremes> extremes = extremesOf(given_.scalar);
    if (!extremes) return;
    add(extremes->smallest, "tiny");
    add(extremes->largest, "huge");
    if (extremes->isSigned) add(-extremes->largest, "huge");
    if (given_.scalar == "unorm" || given_.scalar == "snorm") return;
    if (given_.isStream) add(NAN, {}, given_.elements / 2);
  }

  void add(double value, std::string_view remark, std::int64_t element = -1) {
    const bool isGivenAnyway = given_.low == value && given_.high == value;
    const bool isKnown = std::ranges::find(values_, value) != values_.end();
    if (isGivenAnyway || isKnown) return;
    values_.push_back(value);
    Case made{.kind = Case::Kind::Value};
    const std::string place = element < 0 ? "" : fmt::format("[{}]", element);
    const std::string all = element < 0 && given_.isStream ? " everywhere" : "";
    made.text = fmt::format("{}{} = {:.9g}{}", nameOf(group_), place, value, all);
    if (!remark.empty()) made.text += fmt::format(", {}", remark);
    for (const Given* each : group_) {
      made.settings.push_back(fmt::format("{}.{}{}:{:.17g}", each->kernel, each->parameter, place, value));
    }
    made.mustHold = given_.range.has_value();
    made.hasNan = std::isnan(value);
    cases_.push_back(made);
  }

  const Group& group_;
  const Given& given_;
  std::vector<Case>& cases_;
  std::vector<double> values_;
};

/// The braces of the first size from `from` on: their first character and the one behind them; nullopt if there is none.
struct Braces {
  std::size_t begin, end;
};
std::optional<Braces> sizeIn(std::string_view word, std::size_t from) {
  for (std::size_t begin = word.find('{', from); begin != std::string_view::npos;
       begin = word.find('{', begin + 1)) {
    const std::size_t end = word.find_first_not_of("0123456789", begin + 1);
    if (end != std::string_view::npos && word[end] == '}' && end > begin + 1) return Braces{begin, end + 1};
  }
  return std::nullopt;
}

}  // namespace

std::vector<Case> valueCases(const std::vector<Given>& given, const std::vector<std::string>& only) {
  std::vector<Case> cases;
  for (const Group& group : groupsOf(given, only)) Maker(group, cases).add();
  return cases;
}

bool hasSize(const std::string& word) { return sizeIn(word, 0).has_value(); }

std::string withSize(const std::string& word, std::int64_t size) {
  std::string result;
  std::size_t from = 0;
  for (std::optional<Braces> found = sizeIn(word, 0); found; found = sizeIn(word, from)) {
    result += word.substr(from, found->begin - from);
    result += size == 0 ? word.substr(found->begin + 1, found->end - found->begin - 2) : std::to_string(size);
    from = found->end;
  }
  return result + word.substr(from);
}

}  // namespace sk_tool::stress
