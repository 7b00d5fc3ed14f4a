// SPDX-License-Identifier: MIT
#include "tune/subsets.hpp"

#include <algorithm>

namespace sk_tool::tune {

Setting withAll(Setting setting, std::span<const Step> steps) {
  for (const Step& step : steps) setting = with(std::move(setting), step.changes);
  return setting;
}

void grow(Setting& setting, std::span<const Step> steps, const Holds& holds) {
  Steps open;
  Setting changed;
  for (const Step& step : steps) {
    const bool isTaken = std::ranges::any_of(step.changes, [&](const auto& change) {
      return changed.contains(change.first) || setting.contains(change.first);
    });
    if (isTaken) continue;
    open.push_back(step);
    changed = with(changed, step.changes);
  }
  if (open.empty()) return;
  if (const Setting grown = withAll(setting, open); holds(grown)) {
    setting = grown;
    return;
  }
  if (steps.size() == 1) return;
  const std::size_t half = (steps.size() + 1) / 2;
  grow(setting, steps.first(half), holds);
  grow(setting, steps.subspan(half), holds);
}

Steps shrink(const Setting& setting, Steps steps, const Holds& holds) {
  for (std::size_t parts = 2; steps.size() > 1 && parts <= steps.size();) {
    bool isSmaller = false;
    for (std::size_t part = 0; part < parts && !isSmaller; ++part) {
      Steps rest;
      for (std::size_t i = 0; i < steps.size(); ++i) {
        if (i * parts / steps.size() != part) rest.push_back(steps[i]);
      }
      if (rest.size() == steps.size() || !holds(withAll(setting, rest))) continue;
      steps = std::move(rest);
      isSmaller = true;
    }
    if (isSmaller) {
      parts = std::max<std::size_t>(parts - 1, 2);
    } else if (parts == steps.size()) {
      break;
    } else {
      parts = std::min(2 * parts, steps.size());
    }
  }
  if (steps.size() == 1 && holds(setting)) steps.clear();
  return steps;
}

}  // namespace sk_tool::tune
