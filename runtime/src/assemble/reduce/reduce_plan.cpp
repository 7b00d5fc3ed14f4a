// SPDX-License-Identifier: MIT
//
// Plans the passes. Elements of a block are numbered row-major, whatever the layout. The first pass folds
// runs of consecutive elements, and each later pass runs of consecutive partial results, so that order is
// kept and the number of passes is the depth of a tree over a block's elements.
#include "assemble/reduce/reduce_plan.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "assemble/reduce/scan_plan.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk::assemble {
namespace {

/// A linearised region with dimensions coalesced where elements and blocks allow it, x fastest. Blocks, and
/// the elements of a block, keep their row-major numbers.
struct Axes {
  std::uint8_t count = 0;
  Index4 extent = {1, 1, 1, 1};   ///< of a block
  Index4 blocks = {1, 1, 1, 1};
  Index4 stride = {1, 1, 1, 1};
};

Axes coalesce(const RegionLayout& input, const Index4& division) {
  Axes axes;
  for (std::size_t d = 0; d < input.extent.size(); ++d) {
    if (input.extent[d] == 1) continue;
    const std::int32_t blocks = division[d];
    const std::int32_t extent = input.extent[d] / blocks;
    if (axes.count > 0) {
      const std::size_t below = axes.count - 1u;
      const bool adjacent = input.stride[d] == axes.stride[below] * axes.extent[below] * axes.blocks[below];
      if (adjacent && (axes.blocks[below] == 1 || extent == 1)) {
        axes.extent[below] *= extent;
        axes.blocks[below] *= blocks;
        continue;
      }
    }
    axes.extent[axes.count] = extent;
    axes.blocks[axes.count] = blocks;
    axes.stride[axes.count] = input.stride[d];
    ++axes.count;
  }
  if (axes.count == 0) axes.count = 1;
  return axes;
}

/// Divides a positive number, rounding up, without overflow.
std::int32_t divideUp(std::int32_t a, std::int32_t b) { return (a - 1) / b + 1; }

class Planner {
 public:
  Planner(const RegionLayout& input, const RegionLayout& result, const ReduceLimits& limits,
          const Division& division)
      : elements_(input.extent),
        input_(division.byTexel ? texelsOf(input) : input),
        result_(result),
        limits_(limits),
        division_(division) {
    for (std::size_t d = 0; d < input_.extent.size(); ++d) {
      assert(division.blocks[d] > 0 && input_.extent[d] > 0 && input_.extent[d] % division.blocks[d] == 0);
    }
    assert(elements(division.blocks) == elements(result.extent));
    blocks_ = static_cast<std::int32_t>(elements(result.extent));
    left_ = static_cast<std::int32_t>(elements(input_.extent)) / blocks_;
  }

  std::vector<ReducePass> plan() {
    const bool isByRows = !division_.byGroups && findRows();
    if (division_.byGroups) {
      addBlocks();
    } else if (isByRows) {
      addRows(Walk::Rows);
    } else {
      addPass(division_.byIndex ? Walk::Index : input_.linear ? Walk::Box : Walk::Plane);
    }
    while (!passes_.back().toResult) {
      if (mayGroup()) {
        addGroups();
      } else if (isByRows) {
        addRows(Walk::PartialRows);
      } else {
        addPass(Walk::Partials);
      }
    }
    passes_.back().variant.toBuffer = limits_.toBuffer;
    assert(!division_.ofDigits || keepsRoom(passes_));
    return std::move(passes_);
  }

 private:
  struct Extent2 {
    std::int32_t width, height;
  };

  /// Whether the elements of the only block are rows of texels: in a plane, or in a linearised stream if they
  /// begin at the start of a row. The last row may be shorter if there is another row and order does not
  /// matter.
  bool findRows() {
    if (division_.byIndex || input_.layered || blocks_ > 1) return false;
    if (!input_.linear) {
      left2_ = {input_.extent[0], input_.extent[1]};
      corner_ = input_.origin;
      return true;
    }
    const std::int32_t width = 1 << input_.shift;
    if (!isLine(coalesce(input_, division_.blocks)) || firstNumber() % width != 0) return false;
    left2_ = left_ < width ? Extent2{left_, 1} : Extent2{width, left_ / width};
    tail_ = left_ < width ? 0 : left_ % width;
    corner_ = {0, firstNumber() / width, 0, 0};
    return tail_ == 0 || division_.inAnyOrder;
  }

  static bool isLine(const Axes& axes) { return axes.count == 1 && axes.stride[0] == 1; }

  /// In a linearised stream, the number of the first element.
  std::int32_t firstNumber() const {
    std::int32_t number = 0;
    for (std::size_t d = 0; d < input_.origin.size(); ++d) number += input_.origin[d] * input_.stride[d];
    return number;
  }

  /// The run, of at most `most` texels, for a width x height rectangle. If order matters: a part of a row
  /// that divides it, if there is one, or whole rows. Otherwise, for elements: a part of a column, so that
  /// neighbouring invocations read neighbouring texels; for partial results: a square, which keeps
  /// invocations side by side.
  Extent2 runOf(std::int32_t width, std::int32_t height, std::int32_t most, bool ofPartials) const {
    constexpr std::int32_t side = 8;
    if (division_.inAnyOrder && ofPartials && most >= side && width >= side && height >= most / side)
      return {side, most / side};
    if (division_.inAnyOrder && height >= most) return {1, dividing(height, most)};
    if (width < most && height > 1) return {width, std::min(height, most / width)};
    return {dividing(width, std::min(width, most)), 1};
  }

  /// The run of the first pass. A texel of the partial row below extends the last run of its column.
  Extent2 firstRun() const {
    const auto [width, height] = left2_;
    const std::int32_t most = division_.byTexel ? std::max(limits_.fanIn / lanes, 1) : limits_.fanIn;
    if (hasParts() && height >= longestPart)
      return {1, height >= limits_.longRun ? dividing(height, limits_.longRun) : height};
    if (tail_ > 0) return {1, std::clamp(height, 1, std::max(most - 1, 1))};
    return runOf(width, height, most, false);
  }

  bool hasParts() const { return limits_.longRun > 0 && division_.inAnyOrder && division_.inGroups; }

  /// Whether a specialised program for this length should fold the first runs: if all have it and there is
  /// enough work.
  bool hasKnownRun(const Extent2& run) const {
    constexpr std::int32_t unit = 4;
    const auto [width, height] = left2_;
    const bool isEven = tail_ == 0 && width % run.width == 0 && height % run.height == 0;
    const bool isLine = run.width == 1 || run.height == 1;
    return isEven && isLine && std::int64_t{width} * height >= limits_.knownRuns &&
           run.width * run.height % unit == 0;
  }

  /// A divisor of `extent` near `most`; `most` if there is none.
  static std::int32_t dividing(std::int32_t extent, std::int32_t most) {
    for (std::int32_t length = most; 2 * length > most; --length) {
      if (extent % length == 0) return length;
    }
    return most;
  }

  /// Adds a pass from the remaining rectangle of texels or partial results to a smaller one.
  void addRows(Walk walk) {
    const bool isFirst = walk == Walk::Rows;
    const auto [width, height] = left2_;  // before the pass
    const Extent2 run = isFirst ? firstRun() : runOf(width, height, limits_.fanIn, true);
    const bool isGrouped = isFirst && foldsInGroups();
    const std::int32_t side = isGrouped ? groupSide : 1;
    ReducePass pass{};
    pass.variant.grouped = isGrouped;
    pass.variant.walk = walk;
    pass.variant.packed = isFirst && division_.byTexel;
    if (isFirst) setRun(pass.variant, run);
    left2_ = {divideUp(width, run.width * side), divideUp(height, run.height * side)};
    left_ = left2_.width * left2_.height;
    pass.toResult = left_ == 1;
    pass.uniforms = {{"sk_item_shape", true, elements_},
                     {"sk_origin", true, isFirst ? corner_ : Index4{}},
                     {"sk_source", true, {width, height, isFirst ? tail_ : 0, 0}},
                     {"sk_run_shape", true, {run.width, run.height, 0, 0}}};
    RegionLayout partial;
    partial.extent = {left2_.width, left2_.height, 1, 1};
    pass.texture = {left2_.width, left2_.height, 0};
    addDomain(pass, pass.toResult ? result_ : partial, false);
    addTarget(pass);
    if (!pass.toResult) sourceWidth_ = left2_.width;
    if (pass.toResult) pass.texture = {};
    passes_.push_back(std::move(pass));
  }

  /// Selects a program for such runs: a specialised one for their length if that is worthwhile.
  void setRun(ReduceVariant& variant, const Extent2& run) const {
    const bool isKnown = hasKnownRun(run);
    const bool isLong = hasParts() && run.width == 1 && run.height >= longestPart;
    if (isKnown) variant.run = static_cast<std::uint8_t>(run.width * run.height);
    variant.column = run.width == 1 && (isKnown || isLong || tail_ > 0);
    if (isLong) {
      const bool isWhole = !isKnown || run.height % longestPart == 0;
      variant.part = static_cast<std::uint8_t>(isWhole ? longestPart : longestPart / 2);
    }
  }

  /// Sets where a pass by rows or groups writes. Its program has no other domain uniforms, so that passes
  /// share it.
  static void addTarget(ReducePass& pass) {
    const Rect& drawn = pass.draws.front();
    pass.uniforms.push_back({"sk_target", true, {drawn.x, drawn.y, 0, 0}});
    pass.variant.domain = Domain::Linear;
    pass.variant.domainView = false;
    pass.variant.domainRank = 1;
  }

  /// Whether work groups combine what their invocations have folded from elements.
  bool foldsInGroups() const { return limits_.grouped && division_.inAnyOrder && division_.inGroups; }

  /// Whether work groups fold the remaining partial results: of a single block, without layers.
  bool mayGroup() const { return limits_.grouped && blocks_ == 1 && !partialsLayered_; }

  void addGroups() {
    constexpr std::int32_t shortFan = 16;  // leaves enough groups for a whole GPU
    const bool isLast = left_ <= groupSize * limits_.fanIn;
    const std::int32_t fan =
        isLast ? std::max(divideUp(left_, groupSize), 2) : std::min(limits_.fanIn, shortFan);
    const std::int32_t groups = divideUp(left_, fan * groupSize);
    ReducePass pass{};
    pass.toResult = groups == 1;
    pass.variant.walk = Walk::GroupedPartials;
    pass.variant.strided = division_.inAnyOrder;
    pass.uniforms = {{"sk_item_shape", true, elements_},
                     {"sk_fan", false, {fan}},
                     {"sk_block_length", false, {left_}},
                     {"sk_source_width", false, {sourceWidth_}}};
    left_ = groups;
    addDomain(pass, pass.toResult ? result_ : partials(pass, groups), false);
    addTarget(pass);
    if (!pass.toResult) sourceWidth_ = pass.texture.width;
    passes_.push_back(std::move(pass));
  }

  /// Adds a pass in which a work group folds a block or a part of one.
  void addBlocks() {
    const std::int32_t runs = divideUp(left_, groupSize * mostOfInvocation());
    ReducePass pass{};
    pass.toResult = runs == 1;
    pass.variant.walk = Walk::Index;
    pass.variant.grouped = true;
    pass.variant.packed = division_.byTexel;
    pass.variant.axes = decodedRank({.extent = input_.extent});
    pass.uniforms = {{"sk_fan", false, {divideUp(left_, runs)}},
                     {"sk_block_length", false, {left_}},
                     {"sk_blocks", false, {blocks_}},
                     {"sk_item_shape", true, elements_}};
    setBlocks(pass, blockShape(), division_.blocks);
    setDomain(pass, pass.toResult ? result_ : partials(pass, runs));
    if (pass.toResult && mayJoinBlocks()) {
      pass.variant.twoBlocks = true;
      pass.draws.front().height /= 2;
    }
    left_ = runs;
    passes_.push_back(std::move(pass));
  }

  /// The most elements or texels that an invocation of such a pass folds.
  std::int32_t mostOfInvocation() const {
    return division_.ofDigits ? program::longestRun / (division_.byTexel ? lanes : 1) : 64;
  }

  /// Whether work groups fold two blocks each: there are enough rows of blocks, a row of texels high each.
  bool mayJoinBlocks() const {
    constexpr std::int32_t enoughBlocks = 2048;
    if (division_.ofDigits && left_ > groupSize / 2 * mostOfInvocation()) return false;
    const std::int32_t rows = division_.blocks[1];
    return division_.inAnyOrder && division_.byTexel && !result_.linear && !result_.strided &&
           blocks_ >= enoughBlocks && rows % 2 == 0 && input_.extent[1] == rows &&
           input_.extent[2] * input_.extent[3] == 1 && result_.extent == division_.blocks;
  }

  /// Adds a pass over the `left_` elements, texels or partial results of each block.
  void addPass(Walk walk) {
    const bool isOfTexels = division_.byTexel && walk != Walk::Partials;
    const std::int32_t most = isOfTexels ? std::max(limits_.fanIn / lanes, 1) : limits_.fanIn;
    const std::int32_t runs = divideUp(left_, most);
    const std::int32_t fan = divideUp(left_, runs);  // runs of nearly equal length
    ReducePass pass{};
    pass.toResult = runs == 1;
    pass.variant.packed = isOfTexels;
    pass.variant.runs = blocks_ == 1 ? Runs::OneBlock : pass.toResult ? Runs::WholeBlocks : Runs::Split;
    pass.uniforms = {{"sk_fan", false, {fan}},
                     {"sk_block_length", false, {left_}},
                     {"sk_blocks", false, {blocks_}},
                     {"sk_item_shape", true, elements_}};
    setSource(pass, walk);
    setDomain(pass, pass.toResult ? result_ : partials(pass, runs));
    left_ = runs;
    passes_.push_back(std::move(pass));
  }

  /// Sets the texture for `runs` partial results per block. There are fewer of them than elements, so that a
  /// texture can hold them.
  RegionLayout partials(ReducePass& pass, std::int32_t runs) const {
    const std::int64_t count = std::int64_t{runs} * blocks_;
    const std::optional<TextureShape> texture = linearTexture(count, limits_.texture);
    assert(texture);
    pass.texture = *texture;
    return linearLayout(count, *texture);
  }

  void setSource(ReducePass& pass, Walk walk) {
    pass.variant.walk = walk;
    pass.variant.sourceLayered = walk == Walk::Partials ? partialsLayered_ : input_.layered;
    if (walk == Walk::Partials) {
      pass.uniforms.push_back({"sk_shift", false, {sourceShift_}});
    } else if (walk == Walk::Plane) {
      setBlocks(pass, blockShape(), division_.blocks);
      pass.uniforms.push_back({"sk_origin", true, input_.origin});
    } else if (walk == Walk::Index) {
      pass.variant.axes = decodedRank({.extent = input_.extent});
      setBlocks(pass, blockShape(), division_.blocks);
    } else {
      setLinearSource(pass);
    }
  }

  Index4 blockShape() const {
    Index4 shape{};
    for (std::size_t d = 0; d < shape.size(); ++d) shape[d] = input_.extent[d] / division_.blocks[d];
    return shape;
  }

  void setLinearSource(ReducePass& pass) const {
    const Axes axes = coalesce(input_, division_.blocks);
    pass.uniforms.push_back({"sk_start", false, {firstNumber()}});
    pass.uniforms.push_back({"sk_shift", false, {input_.shift}});
    if (isLine(axes)) {
      pass.variant.walk = Walk::Line;
      return;
    }
    pass.variant.axes = axes.count;
    setBlocks(pass, axes.extent, axes.blocks);
    pass.uniforms.push_back({"sk_stride", true, axes.stride});
  }

  static void setBlocks(ReducePass& pass, const Index4& extent, const Index4& blocks) {
    pass.uniforms.push_back({"sk_block_shape", true, extent});
    pass.uniforms.push_back({"sk_block_step", true, stridesOf(extent)});
    pass.uniforms.push_back({"sk_blocks_step", true, stridesOf(blocks)});
  }

  void setDomain(ReducePass& pass, const RegionLayout& domain) {
    const bool isByBlocks = pass.variant.walk == Walk::Plane && pass.variant.runs == Runs::WholeBlocks;
    pass.variant.reshaped = isByBlocks && domain.extent != division_.blocks;
    addDomain(pass, domain, isByBlocks && !pass.variant.reshaped);
    if (pass.toResult) return;
    sourceShift_ = domain.shift;
    sourceWidth_ = 1 << domain.shift;
    partialsLayered_ = domain.layered;
  }

  const Index4 elements_;
  const RegionLayout input_;  ///< of elements or of texels
  const RegionLayout& result_;
  const ReduceLimits& limits_;
  const Division& division_;
  std::int32_t blocks_;
  std::int32_t left_;  ///< elements, texels or partial results per block
  Extent2 left2_{};  ///< the same as a rectangle, in passes by rows
  Index4 corner_{};  ///< its first texel, before the first pass
  std::int32_t tail_ = 0;  ///< texels in the partial last row, before the first pass
  std::int32_t sourceShift_ = 0;  ///< of the texture of partial results
  std::int32_t sourceWidth_ = 0;  ///< its width, in passes by rows or groups
  bool partialsLayered_ = false;  ///< whether it has layers
  std::vector<ReducePass> passes_;
};

}  // namespace

bool foldsInGroups(const program::Reduction& reduction) {
  const bool foldCombines =
      reduction.combine.entry == reduction.fold.entry && reduction.combine.body == reduction.fold.body;
  return !reduction.seeded && (foldCombines || !reduction.addition.empty());
}

bool mayEndInBuffer(const program::Reduction& reduction) {
  constexpr std::size_t mostPlanes = 8;
  std::size_t planes = 0;
  for (const program::Parameter& parameter : reduction.fold.parameters) {
    if (parameter.role != program::Role::Accumulator) continue;
    const auto& fields = parameter.element->fields;
    planes += fields.size();
    if (std::ranges::any_of(fields, [](const program::Field& field) {
          return program::hostBytes(field.scalar) < sizeof(std::uint32_t);
        }))
      return false;
  }
  return planes <= mostPlanes;
}

bool readsElementIndex(const program::Kernel& fold) {
  using program::Role;
  return fold.usesIndex || fold.usesExtent ||
         std::ranges::any_of(fold.parameters, [](const program::Parameter& parameter) {
           return parameter.role == Role::Iterator || parameter.usesNear ||
                  (parameter.role == Role::Input && parameter.usesIndex) ||
                  (parameter.role == Role::Output && (parameter.usesIndex || parameter.usesExtent));
         });
}

std::vector<ReducePass> planReduction(const RegionLayout& elements, const RegionLayout& result,
                                      const ReduceLimits& limits, const Division& division) {
  assert(limits.fanIn >= 2);
  return Planner(elements, result, limits, division).plan();
}

std::vector<ReducePass> planReduction(const RegionLayout& elements, const RegionLayout& result,
                                      const ReduceLimits& limits) {
  return planReduction(elements, result, limits, {.blocks = result.extent});
}

void addDomain(ReducePass& pass, const RegionLayout& domain, bool usesIndex) {
  pass.variant.domain = domainOf(domain);
  pass.variant.domainView = !domain.linear && domain.origin != Index4{};
  pass.variant.domainLayered = domain.layered;
  if (usesIndex || pass.variant.domain == Domain::LinearBox) pass.variant.domainRank = decodedRank(domain);
  pass.draws = drawnTexels(domain);
  pass.uniforms.push_back({"sk_domain_origin", true, domain.origin});
  pass.uniforms.push_back({"sk_domain_shape", true, domain.extent});
  pass.uniforms.push_back({"sk_domain_stride", true, domain.stride});
  pass.uniforms.push_back({"sk_domain_shift", false, {domain.shift}});
  pass.uniforms.push_back({"sk_domain_step", true, stridesOf(domain.extent)});
}

ReducePass planIdentities(const RegionLayout& result) {
  ReducePass pass{};
  pass.toResult = true;
  pass.variant.walk = Walk::Nothing;
  addDomain(pass, result, false);
  return pass;
}

RegionLayout valueLayout() { return {.linear = true}; }

}  // namespace sk::assemble
