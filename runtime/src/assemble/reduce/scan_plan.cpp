// SPDX-License-Identifier: MIT
#include "assemble/reduce/scan_plan.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"
#include "sk/exact_digits.hpp"
#include "sk/scalar_bytes.hpp"

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
    divide(levels_.back());
  }

  ScanPlan plan(bool isExclusive) {
    ScanPlan plan;
    const Level& elements = levels_.front();
    const bool isChained = access_.chained && lines_ == 1 && elements.unit == ScanUnit::Tile &&
                           elements.length > elements.folded();
    while (!isChained && levels_.back().length > levels_.back().folded()) {
      const std::size_t from = levels_.size() - 1;
      levels_.push_back(partials((levels_.back().length - 1) / levels_.back().folded() + 1));
      divide(levels_.back());
      ReducePass pass = passOver(from, ScanPass::Folds);
      setTarget(pass, levels_.back());
      plan.folds.push_back(std::move(pass));
    }
    for (std::size_t level = levels_.size() - 1; level > 0; --level) {
      ReducePass pass = passOver(level, ScanPass::Inclusive);
      setTarget(pass, levels_[level]);
      setGroups(pass, levels_[level]);
      plan.scans.push_back(std::move(pass));
    }
    ReducePass pass = passOver(0, isExclusive ? ScanPass::Exclusive : ScanPass::Inclusive);
    pass.toResult = true;
    pass.variant.chained = isChained;
    addDomain(pass, result_, false);
    setGroups(pass, levels_[0]);
    plan.scans.push_back(std::move(pass));
    assert(!access_.ofDigits || keepsRoom(plan));
    return plan;
  }

 private:
  struct Level {
    std::int32_t length;  ///< items of a line
    std::int32_t inner;  ///< their distance
    TextureShape texture;  ///< of the results of runs
    RegionLayout layout = {};
    ScanUnit unit = ScanUnit::Item;
    std::int32_t run = 0;  ///< items of a run

    /// The items that are folded to one of the next level.
    std::int32_t folded() const { return unit == ScanUnit::Tile ? run * tileGroup : run; }
  };

  /// Chooses what an invocation computes. Lines that are one element apart are walked side by side, each by invocations
  /// of its own; a line whose elements are neighbours is divided into tiles, unless it is short.
  void divide(Level& level) const {
    constexpr std::int32_t shortLine = 128;
    const bool isOfElements = levels_.size() == 1;
    const std::int32_t most = isOfElements ? access_.elementRun : access_.partialRun;
    if (limits_.grouped && level.inner > 1) {
      level.unit = ScanUnit::Run;
      level.run = access_.ofDigits ? program::longestContinuedRun : program::longestRun;
    } else if (limits_.grouped && most > 0 && (lines_ == 1 || level.length >= shortLine)) {
      level.unit = ScanUnit::Tile;
      level.run = runInTile(level.length, most, isOfElements);
    } else {
      level.run = isOfElements && access_.byTexel ? limits_.fanIn / lanes : limits_.fanIn;
    }
  }

  /// Long runs save work, but a large GPU wants many tiles.
  std::int32_t runInTile(std::int32_t length, std::int32_t most, bool isOfElements) const {
    constexpr std::int64_t enoughTiles = 256;
    if (length <= tileGroup * most || !isOfElements) {
      const std::int32_t least = std::min((length - 1) / tileGroup + 1, most);
      return static_cast<std::int32_t>(std::bit_ceil(static_cast<std::uint32_t>(least)));
    }
    const std::int64_t perInvocation = std::int64_t{length} * lines_ / (tileGroup * enoughTiles);
    return static_cast<std::int32_t>(
        std::bit_floor(static_cast<std::uint64_t>(std::clamp<std::int64_t>(perInvocation, 1, most))));
  }

  /// A level with this many results in each line. There are fewer of them than elements, so that a texture can hold
  /// them.
  Level partials(std::int32_t length) const {
    const std::int64_t count = std::int64_t{length} * lines_;
    const std::optional<TextureShape> texture = linearTexture(count, limits_.texture);
    assert(texture);
    return {length, lines_, *texture, linearLayout(count, *texture)};
  }

  /// A pass that reads a level, and, on the way back, the results of the runs of this level.
  ReducePass passOver(std::size_t level, ScanPass scan) const {
    const Level& source = levels_[level];
    ReducePass pass{};
    pass.variant.scan = scan;
    pass.variant.walk = level > 0          ? Walk::Partials
                        : access_.byIndex  ? Walk::Index
                        : elements_.linear ? Walk::Line
                                           : Walk::Plane;
    pass.variant.runs = lines_ == 1 ? Runs::OneBlock : Runs::Split;
    pass.variant.unit =
        scan == ScanPass::Folds && source.unit == ScanUnit::Run ? ScanUnit::Item : source.unit;
    pass.variant.run = static_cast<std::uint8_t>(source.run);
    pass.variant.packed = level == 0 && access_.byTexel;
    pass.variant.ofDigits = level > 0 && scan != ScanPass::Folds && access_.ofDigits;
    pass.variant.axes = decodedRank({.extent = extent_});
    pass.variant.sourceLayered = source.layout.layered;
    pass.uniforms = {{"sk_inner", false, {source.inner}},
                     {"sk_length", false, {source.length}},
                     {"sk_lines", false, {lines_}},
                     {"sk_shift", false, {source.layout.shift}},
                     {"sk_start", false, {level == 0 ? firstNumber(elements_) : 0}},
                     {"sk_origin", true, elements_.origin},
                     {"sk_width", false, {elements_.extent[0]}},
                     {"sk_item_shape", true, extent_},
                     {"sk_item_step", true, stridesOf(extent_)}};
    if (level == 0 && source.unit == ScanUnit::Tile)
      pass.uniforms.push_back({"sk_pairs", false, {pairedShift(source, scan != ScanPass::Folds)}});
    if (scan != ScanPass::Folds && level + 1 < levels_.size()) {
      const RegionLayout& carry = levels_[level + 1].layout;
      pass.variant.carried = true;
      pass.variant.carryLayered = carry.layered;
      pass.uniforms.push_back({"sk_carry_shift", false, {carry.shift}});
    }
    return pass;
  }

  /// The shift of the elements' texture, and of the results', if each tile consists of pairs of rows of both; else 0.
  std::int32_t pairedShift(const Level& elements, bool writes) const {
    const auto isPaired = [&](const RegionLayout& region) {
      const std::int32_t pair = 2 << region.shift;
      return region.linear && region.shift >= 2 && firstNumber(region) % pair == 0 &&
             elements.folded() % pair == 0;
    };
    if (lines_ > 1 || access_.byIndex || !isPaired(elements_)) return 0;
    return !writes || (isPaired(result_) && result_.shift == elements_.shift) ? elements_.shift : 0;
  }

  static void setTarget(ReducePass& pass, const Level& level) {
    pass.texture = level.texture;
    addDomain(pass, level.layout, false);
  }

  /// Sets the work groups of a pass over a level that stores its results by itself.
  void setGroups(ReducePass& pass, const Level& level) const {
    if (pass.variant.unit == ScanUnit::Item) return;
    const std::int32_t runs = (level.length - 1) / level.folded() + 1;
    const std::int64_t count = level.unit == ScanUnit::Tile
                                   ? std::int64_t{runs} * lines_
                                   : (std::int64_t{runs} * lines_ - 1) / tileGroup + 1;
    const std::int64_t width = std::min<std::int64_t>(count, std::int64_t{1} << groupRowShift);
    pass.groups = {0, 0, static_cast<std::int32_t>(width),
                   static_cast<std::int32_t>((count - 1) / width + 1)};
    pass.uniforms.push_back({"sk_groups", false, {static_cast<std::int32_t>(count)}});
    pass.uniforms.push_back({"sk_patience", false, {access_.patience}});
  }

  const Index4 extent_;
  const RegionLayout elements_, result_;  ///< in elements or in texels
  const ReduceLimits& limits_;
  const ScanAccess& access_;
  std::int32_t lines_;
  std::vector<Level> levels_;  ///< the elements, then the results of their runs or tiles, and so on
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

void addTiles(ScanAccess& access, const program::Reduction& reduction, bool chains) {
  access.partialRun = longestRunInTile(reduction, false);
  access.chained = chains && mayChain(reduction);
  if (combinesInFold(reduction)) access.elementRun = longestRunInTile(reduction, access.byTexel);
}

bool isConsecutive(const RegionLayout& elements) {
  std::int32_t next = 1;
  for (std::size_t d = 0; d < elements.extent.size(); ++d) {
    if (elements.linear && elements.extent[d] > 1 && elements.stride[d] != next) return false;
    next *= elements.extent[d];
  }
  return elements.linear || elements.extent[2] * elements.extent[3] == 1;
}

ScanPlan planScan(const RegionLayout& elements, const RegionLayout& result, const ReduceLimits& limits,
                  const Lines& lines, const ScanAccess& access, bool isExclusive) {
  assert(limits.fanIn >= 2 * lanes);
  return ScanPlanner(elements, result, limits, lines, access).plan(isExclusive);
}

using program::Kernel;
using program::Parameter;
using program::Reduction;

namespace {

/// The bytes of shared memory that an accumulator takes, or more.
std::size_t sharedBytes(const program::Element& element) {
  std::size_t bytes = 0;
  for (const program::Field& field : element.fields) {
    const std::size_t scalar = program::is64Bit(field.scalar) ? 8 : 4;
    bytes += scalar * std::bit_ceil(std::size_t{field.width});
  }
  return bytes;
}

std::size_t sharedBytes(const Kernel& fold) {
  std::size_t bytes = 0;
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role == program::Role::Accumulator) bytes += sharedBytes(*parameter.element);
  }
  return bytes;
}

}  // namespace

std::int32_t longestRunInTile(const Reduction& reduction, bool packed) {
  constexpr std::size_t runBytes = 64;  // a tile of such runs takes half of groupBytes
  const std::size_t bytes = sharedBytes(reduction.fold);
  if (bytes * tileGroup > groupBytes / 2) return 0;
  const std::size_t most = packed ? 4 : 16;
  return static_cast<std::int32_t>(
      std::clamp<std::size_t>(std::bit_floor(runBytes / (packed ? lanes * bytes : bytes)), 1, most));
}

bool mayChain(const Reduction& reduction) {
  constexpr std::size_t mostAccumulators = 4;
  std::size_t count = 0;
  for (const Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role != program::Role::Accumulator) continue;
    const auto fields = parameter.element->fields;
    const program::Scalar scalar = fields.front().scalar;
    if (isStruct(*parameter.element) || fields.front().width != 1) return false;
    if (scalar != program::Scalar::Int && scalar != program::Scalar::Uint) return false;
    ++count;
  }
  return count <= mostAccumulators && combinesInFold(reduction);
}

bool combinesInFold(const Reduction& reduction) {
  return !reduction.addition.empty() ||
         (reduction.combine.entry == reduction.fold.entry && reduction.combine.body == reduction.fold.body);
}

namespace {

using Load = program::DigitLoad<std::int32_t>;

/// A load that may be too large.
using Terms = std::int64_t;
constexpr Terms combined = Load::most - Load::combined().room();
bool fits(Terms load) { return load <= Load::most; }

Index4 valueOf(const ReducePass& pass, std::string_view uniform) {
  const auto found = std::ranges::find(pass.uniforms, uniform, &UniformValue::name);
  assert(found != pass.uniforms.end());
  return found->value;
}

/// The most elements or texels that a pass over elements folds one after the other.
Terms stepsOf(const ReducePass& pass) {
  const ReduceVariant& variant = pass.variant;
  if (variant.scan != ScanPass::None) return variant.run;
  if (variant.walk == Walk::Rows) {
    if (variant.part > 0) return variant.part;
    const Index4 run = valueOf(pass, "sk_run_shape");
    const bool mayHaveTail = variant.column && variant.run == 0;  // a texel of the partial row below
    return Terms{run[0]} * run[1] + (mayHaveTail ? 1 : 0);
  }
  const Terms fan = valueOf(pass, "sk_fan")[0];
  if (!variant.grouped) return fan;
  const Terms invocations = variant.twoBlocks ? groupSize / 2 : groupSize;
  return (fan + invocations - 1) / invocations;
}

/// The load of an invocation's result, which starts from zero.
Terms loadOf(const ReducePass& pass) {
  if (isOfPartials(pass.variant.walk)) return combined;
  const Terms steps = stepsOf(pass), ofStep = pass.variant.packed ? lanes : 1;
  if (pass.variant.part == 0) return steps * ofStep;
  // a part by itself, or what remains after the parts, which have been combined
  return std::max(steps * ofStep, combined + (steps - 1) * ofStep);
}

/// The load of the results of a scan's pass over elements, which continue from a carry.
Terms loadOf(const ReducePass& pass, Terms carry) {
  const Terms run = loadOf(pass);
  if (pass.variant.unit != ScanUnit::Tile) return carry + run;
  // the group combines the results of its runs, which then start from those before them
  return std::max(carry + run, combined) + run;
}

}  // namespace

bool keepsRoom(std::span<const ReducePass> passes) {
  return std::ranges::all_of(passes, [](const ReducePass& pass) { return fits(loadOf(pass)); });
}

bool keepsRoom(const ScanPlan& plan) {
  if (!keepsRoom(plan.folds)) return false;
  const Terms ofFolds = plan.folds.empty() ? 0 : std::max(loadOf(plan.folds.front()), combined);
  Terms carry = 0;
  for (const ReducePass& pass : plan.scans) {
    if (!isOfPartials(pass.variant.walk)) {
      if (!fits(loadOf(pass, carry))) return false;
    } else {
      carry = pass.variant.ofDigits ? combined : ofFolds;
    }
  }
  return true;
}

}  // namespace sk::assemble
