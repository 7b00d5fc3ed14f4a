// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_plan.hpp"

#include <cassert>
#include <optional>

namespace sk::assemble {
namespace {

/// In a linearised stream, the number of a region's first element.
std::int32_t firstNumber(const RegionLayout& region) {
  std::int32_t number = 0;
  for (std::size_t d = 0; d < region.origin.size(); ++d) number += region.origin[d] * region.stride[d];
  return number;
}

class ScanPlanner {
 public:
  ScanPlanner(const RegionLayout& elements, const RegionLayout& result, const ReduceLimits& limits,
              const Lines& lines, const ScanAccess& access)
      : extent_(elements.extent),
        elements_(access.byTexel ? texelsOf(elements) : elements),
        result_(access.byTexel ? texelsOf(result) : result),
        limits_(limits),
        access_(access) {
    lines_ = static_cast<std::int32_t>(assemble::elements(extent_) / lines.length);
    const std::int32_t length = access.byTexel ? lines.length / lanes : lines.length;
    levels_.push_back({.length = length, .inner = lines.inner, .texture = {}, .layout = elements_});
  }

  ScanPlan plan(bool isExclusive) {
    ScanPlan plan;
    while (levels_.back().length > runOf(levels_.size() - 1)) {
      const std::size_t from = levels_.size() - 1;
      levels_.push_back(partials((levels_.back().length - 1) / runOf(from) + 1));
      ReducePass pass = passOver(from, ScanPass::Folds);
      setTarget(pass, levels_.back());
      plan.folds.push_back(std::move(pass));
    }
    for (std::size_t level = levels_.size() - 1; level > 0; --level) {
      ReducePass pass = passOver(level, ScanPass::Inclusive);
      setTarget(pass, levels_[level]);
      plan.scans.push_back(std::move(pass));
    }
    ReducePass pass = passOver(0, isExclusive ? ScanPass::Exclusive : ScanPass::Inclusive);
    pass.toResult = true;
    addDomain(pass, result_, false);
    plan.scans.push_back(std::move(pass));
    return plan;
  }

 private:
  struct Level {
    std::int32_t length;  ///< items of a line
    std::int32_t inner;  ///< their distance
    TextureShape texture;  ///< of the results of runs
    RegionLayout layout = {};
  };

  /// A level with this many results in each line. There are fewer of them than elements, so that a texture can hold
  /// them.
  Level partials(std::int32_t length) const {
    const std::int64_t count = std::int64_t{length} * lines_;
    const std::optional<TextureShape> texture = linearTexture(count, limits_.texture);
    assert(texture);
    return {length, lines_, *texture, linearLayout(count, *texture)};
  }

  /// The items of a run: elements, texels or results.
  std::int32_t runOf(std::size_t level) const {
    return level == 0 && access_.byTexel ? limits_.fanIn / lanes : limits_.fanIn;
  }

  /// A pass that reads a level, and, on the way back, the results of the runs of this level.
  ReducePass passOver(std::size_t level, ScanPass scan) const {
    const Level& source = levels_[level];
    ReducePass pass{};
    pass.variant.scan = scan;
    pass.variant.walk = level > 0 ? Walk::Partials : access_.byIndex ? Walk::Index : Walk::Line;
    pass.variant.runs = lines_ == 1 ? Runs::OneBlock : Runs::Split;
    pass.variant.run = static_cast<std::uint8_t>(runOf(level));
    pass.variant.packed = level == 0 && access_.byTexel;
    pass.variant.axes = decodedRank({.extent = extent_});
    pass.variant.sourceLayered = source.layout.layered;
    pass.uniforms = {{"sk_inner", false, {source.inner}},
                     {"sk_length", false, {source.length}},
                     {"sk_lines", false, {lines_}},
                     {"sk_shift", false, {source.layout.shift}},
                     {"sk_start", false, {level == 0 ? firstNumber(elements_) : 0}},
                     {"sk_item_shape", true, extent_},
                     {"sk_item_step", true, stridesOf(extent_)}};
    if (scan != ScanPass::Folds && level + 1 < levels_.size()) {
      const RegionLayout& carry = levels_[level + 1].layout;
      pass.variant.carried = true;
      pass.variant.carryLayered = carry.layered;
      pass.uniforms.push_back({"sk_carry_shift", false, {carry.shift}});
    }
    return pass;
  }

  static void setTarget(ReducePass& pass, const Level& level) {
    pass.texture = level.texture;
    addDomain(pass, level.layout, false);
  }

  const Index4 extent_;
  const RegionLayout elements_, result_;  ///< in elements or in texels
  const ReduceLimits& limits_;
  const ScanAccess& access_;
  std::int32_t lines_;
  std::vector<Level> levels_;  ///< the elements, then the results of their runs, and so on
};

}  // namespace

Lines linesOf(const Index4& extent, const Index4& blocks) {
  const auto count = static_cast<std::int32_t>(elements(extent));
  if (elements(blocks) == 1) return {count, 1};
  std::int32_t inner = 1;
  for (std::size_t d = 0; d < extent.size(); ++d) {
    if (blocks[d] != extent[d]) return {extent[d], inner};
    inner *= extent[d];
  }
  return {1, 1};
}

bool isConsecutive(const RegionLayout& elements) {
  std::int32_t next = 1;
  for (std::size_t d = 0; d < elements.extent.size(); ++d) {
    if (elements.extent[d] > 1 && elements.stride[d] != next) return false;
    next *= elements.extent[d];
  }
  return elements.linear;
}

ScanPlan planScan(const RegionLayout& elements, const RegionLayout& result, const ReduceLimits& limits,
                  const Lines& lines, const ScanAccess& access, bool isExclusive) {
  assert(limits.fanIn >= 2 * lanes);
  return ScanPlanner(elements, result, limits, lines, access).plan(isExclusive);
}

}  // namespace sk::assemble
