// SPDX-License-Identifier: MIT
#include "ir/print_reach.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace skc::ir {
namespace {

std::vector<std::string_view> specNames(const Kernel& kernel) {
  std::vector<std::string_view> names;
  for (const KernelParam& param : kernel.params) {
    if (param.role == ParamRole::Spec) names.push_back(param.name);
  }
  return names;
}

/// "2 * radius + 1".
std::string text(const Kernel& kernel, const Distance& distance) {
  const std::vector<std::string_view> names = specNames(kernel);
  std::string result;
  const auto add = [&](std::int64_t number, const std::string& term) {
    result += result.empty() ? (number < 0 ? "-" : "") : (number < 0 ? " - " : " + ");
    result += term;
  };
  for (std::size_t s = 0; s < names.size(); ++s) {
    const int factor = distance.perSpec[s];
    if (factor == 0) continue;
    add(factor,
        std::abs(factor) == 1 ? std::string(names[s]) : fmt::format("{} * {}", std::abs(factor), names[s]));
  }
  if (result.empty() || distance.constant != 0)
    add(distance.constant, fmt::format("{}", std::abs(distance.constant)));
  return result;
}

/// The largest of several distances.
std::string farthest(const Kernel& kernel, const std::vector<Distance>& distances) {
  std::vector<std::string> texts;
  for (const Distance& distance : distances) {
    std::string one = text(kernel, distance);
    if (std::ranges::find(texts, one) == texts.end()) texts.push_back(std::move(one));
  }
  if (texts.size() > 1) std::erase(texts, "0");
  return texts.size() == 1 ? texts.front() : fmt::format("max({})", fmt::join(texts, ", "));
}

}  // namespace

std::string printReach(const Kernel& kernel, const KernelParam& param) {
  std::vector<std::string> texts;
  for (std::uint8_t d = 0; d < param.rank; ++d) {
    std::vector<Distance> below, above;
    Reach::Kind kind = Reach::Kind::Near;
    for (const Reach& reach : param.reach) {
      if (reach.dimension != d) continue;
      kind = std::max(kind, reach.kind);
      below.push_back(reach.below);
      above.push_back(reach.above);
    }
    std::string& one = texts.emplace_back(1, "xyzw"[d]);
    if (kind != Reach::Kind::Near) {
      one += kind == Reach::Kind::Whole ? " whole" : " computed";
      continue;
    }
    const std::string low = farthest(kernel, below), high = farthest(kernel, above);
    const bool isSum = low.find(' ') != std::string::npos && !low.starts_with("max");
    one += low == "0" ? " 0" : isSum ? fmt::format(" -({})", low) : " -" + low;
    if (low != "0" || high != "0") one += " to " + high;
  }
  return fmt::format("{}{}", fmt::join(texts, ", "), param.promise.empty() ? "" : ", as promised");
}

}  // namespace skc::ir
