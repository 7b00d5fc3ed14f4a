// SPDX-License-Identifier: MIT
#include "analysis/reach_records.hpp"

#include <algorithm>
#include <cstddef>

namespace skc::analysis {

using namespace ir;

namespace {

/// More distances that differ in their Spec parameters count as unknown.
constexpr std::size_t mostDistances = 8;

void keepFarthest(std::vector<Distance>& known, const Distance& distance) {
  const auto alike = std::ranges::find(known, distance.perSpec, &Distance::perSpec);
  if (alike == known.end()) {
    known.push_back(distance);
  } else {
    alike->constant = std::max(alike->constant, distance.constant);
  }
}

Reach::Kind farthest(Reach::Kind a, Reach::Kind b) { return std::max(a, b); }

}  // namespace

ReachRecords::ReachRecords(const Kernel& kernel) {
  for (const KernelParam& param : kernel.params) {
    gathers_.emplace_back().dimensions.resize(param.role == ParamRole::Gather ? param.rank : 0);
  }
}

void ReachRecords::add(std::uint32_t param, const std::vector<IndexValue>& index) {
  Gather& gather = gathers_[param];
  for (std::size_t d = 0; d < gather.dimensions.size(); ++d) {
    Dimension& dimension = gather.dimensions[d];
    const IndexValue& value = index[d];
    if (!value.isSet) continue;
    if (!value.range || !value.range->fromElement[d].isBounded()) {
      dimension.kind =
          farthest(dimension.kind, value.depends == OnNothing ? Reach::Kind::Whole : Reach::Kind::Computed);
      continue;
    }
    gather.shapes |= value.range->shapes;
    dimension.add({*value.range->fromElement[d].negatedLow}, {*value.range->fromElement[d].high});
  }
}

void ReachRecords::Dimension::add(const std::vector<Distance>& before, const std::vector<Distance>& after) {
  for (const Distance& distance : before) keepFarthest(below, distance);
  for (const Distance& distance : after) keepFarthest(above, distance);
  if (std::max(below.size(), above.size()) > mostDistances) kind = farthest(kind, Reach::Kind::Computed);
}

void ReachRecords::merge(const ReachRecords& others) {
  for (std::size_t g = 0; g < gathers_.size(); ++g) {
    const Gather& from = others.gathers_[g];
    gathers_[g].shapes |= from.shapes;
    for (std::size_t d = 0; d < from.dimensions.size(); ++d) {
      Dimension& into = gathers_[g].dimensions[d];
      into.kind = farthest(into.kind, from.dimensions[d].kind);
      into.add(from.dimensions[d].below, from.dimensions[d].above);
    }
  }
}

void ReachRecords::addUnknown(std::uint32_t param, std::uint8_t depends) {
  add(param, std::vector<IndexValue>(dimensions, {true, depends}));
}

void ReachRecords::giveUp() {
  for (Gather& gather : gathers_) {
    for (Dimension& dimension : gather.dimensions) dimension.kind = Reach::Kind::Computed;
  }
}

std::vector<GatherReach> ReachRecords::take() const {
  std::vector<GatherReach> result;
  for (const Gather& gather : gathers_) {
    GatherReach& reach = result.emplace_back();
    for (std::size_t d = 0; d < gather.dimensions.size(); ++d) {
      const Dimension& from = gather.dimensions[d];
      const auto number = static_cast<std::uint8_t>(d);
      if (from.kind != Reach::Kind::Near) {
        reach.reach.push_back({number, from.kind});
        continue;
      }
      const std::size_t count = std::max({from.below.size(), from.above.size(), std::size_t{1}});
      const auto at = [](const std::vector<Distance>& list, std::size_t i) {
        Distance distance = i < list.size() ? list[i] : Distance();
        if (distance.perSpec == Distance().perSpec)
          distance.constant = std::max<std::int64_t>(distance.constant, 0);
        return distance;
      };
      for (std::size_t i = 0; i < count; ++i)
        reach.reach.push_back({number, Reach::Kind::Near, at(from.below, i), at(from.above, i)});
    }
    reach.shapes = gather.shapes;
  }
  return result;
}

}  // namespace skc::analysis
