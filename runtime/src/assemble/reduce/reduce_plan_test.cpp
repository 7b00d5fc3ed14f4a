// SPDX-License-Identifier: MIT
//
// Runs schedules in C++ on strings, whose concatenation does not commute: a block's result must be its elements'
// names in row-major order. Fragment does what reduceProgram emits; reading an unwritten texel is an error.
#include "assemble/reduce/reduce_plan.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

using namespace sk::assemble;

namespace {

using Name = std::u16string;

struct Texture {
  Texture(int w, int h)
      : width(w), height(h), texels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  std::optional<Name>& at(int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) throw std::out_of_range("texel outside its texture");
    return texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }

  int width, height;
  std::vector<std::optional<Name>> texels;
};

Index4 operator+(const Index4& a, const Index4& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]};
}
Index4 operator-(const Index4& a, const Index4& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}
Index4 operator*(const Index4& a, const Index4& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]};
}

int ravel(const Index4& index, const Index4& strides) {
  const Index4 p = index * strides;
  return p[0] + p[1] + p[2] + p[3];
}

Index4 unravel(int number, const Index4& strides, int rank) {
  Index4 index{};
  for (int d = rank - 1; d > 0; --d) {
    const auto axis = static_cast<std::size_t>(d);
    index[axis] = number / strides[axis];
    number -= index[axis] * strides[axis];
  }
  index[0] = number;
  return index;
}

bool inside(const Index4& index, const Index4& extent) {
  for (std::size_t d = 0; d < 4; ++d) {
    if (index[d] < 0 || index[d] >= extent[d]) return false;
  }
  return true;
}

/// A region of a stream: a whole stream, or a part with margins around it.
struct Region {
  RegionLayout regionLayout;
  int width, height;  ///< of its texture

  std::pair<int, int> texel(const Index4& index) const {
    const Index4 p = index + regionLayout.origin;
    const int elements = regionLayout.packed ? lanes : 1;
    if (!regionLayout.linear) return {p[0] / elements, p[1]};
    const int number = ravel(p, regionLayout.stride) / elements;
    return {number & ((1 << regionLayout.shift) - 1), number >> regionLayout.shift};
  }
};

/// One fragment of one pass.
class Fragment {
 public:
  Fragment(const ReducePass& pass, Texture& source, const Region& input, int x, int y)
      : pass_(pass), source_(source), input_(input), x_(x), y_(y) {}

  /// Nullopt if the fragment is discarded.
  std::optional<Name> run() {
    if (pass_.variant.walk == Walk::Rows || pass_.variant.walk == Walk::PartialRows) return runRows();
    if (pass_.variant.walk == Walk::GroupedPartials) return runGroup();
    if (!locate()) return {};
    findRun();
    startWalk();
    Name total = fetch(0);
    for (int k = 1; k < count_; ++k) {
      step();
      total += fetch(k);
    }
    return total;
  }

 private:
  const Index4& vector(std::string_view name) const {
    const auto value = std::ranges::find(pass_.uniforms, name, &UniformValue::name);
    if (value == pass_.uniforms.end()) throw std::logic_error(std::string(name));
    return value->value;
  }
  int integer(std::string_view name) const { return vector(name)[0]; }

  Name runRows() {
    const ReduceVariant& v = pass_.variant;
    const int width = v.run == 0 ? vector("sk_run_shape")[0] : v.column ? 1 : v.run;
    const int height = v.run == 0 ? vector("sk_run_shape")[1] : v.column ? v.run : 1;
    const Index4& target = vector("sk_target");
    const int left = (x_ - target[0]) * width;
    const int top = (y_ - target[1]) * height;
    const Index4& extent = vector("sk_source");
    if (v.grouped) {
      Name all;
      for (int k = 0; k < groupSide * groupSide; ++k) {
        const int x = (x_ - target[0]) * groupSide + k % groupSide;
        const int y = (y_ - target[1]) * groupSide + k / groupSide;
        all += rectangle(x * width, y * height, width, height);
      }
      return all;
    }
    if (v.run > 0 && (left + width > extent[0] || top + height > extent[1])) {
      throw std::logic_error("a run of constant length passes the end");
    }
    return rectangle(left, top, width, height);
  }

  /// The part of a rectangle that is inside the source, row by row.
  Name rectangle(int left, int top, int width, int height) {
    Name total;
    const Index4& end = vector("sk_source");
    for (int y = top; y < std::min(top + height, end[1]); ++y) {
      for (int x = left; x < std::min(left + width, end[0]); ++x) {
        total += element(vector("sk_origin")[0] + x, vector("sk_origin")[1] + y);
      }
    }
    if (top < end[1] && top + height >= end[1] && left < end[2])  // one more texel, below the rows
      total += element(vector("sk_origin")[0] + left, vector("sk_origin")[1] + end[1]);
    return total;
  }

  /// The value that a work group leaves in its first invocation.
  Name runGroup() {
    const Index4& target = vector("sk_target");
    const int group = (y_ - target[1]) << integer("sk_domain_shift") | (x_ - target[0]);
    const int fan = integer("sk_fan");
    const int width = integer("sk_source_width");
    const int base = group * groupSize * fan;
    const int left = std::min(groupSize * fan, integer("sk_block_length") - base);
    std::vector<Name> runs;
    for (int i = 0; i < groupSize; ++i) {
      Name total;
      for (int k = 0; k < fan; ++k) {
        const int at = pass_.variant.strided ? i + k * groupSize : i * fan + k;
        if (at < left) total += element((base + at) % width, (base + at) / width);
      }
      runs.push_back(total);
    }
    for (std::size_t s = 1; s < runs.size(); s *= 2) {
      for (std::size_t i = 0; i + s < runs.size(); i += 2 * s) runs[i] += runs[i + s];
    }
    return runs.front();
  }

  bool locate() {
    const ReduceVariant& v = pass_.variant;
    if (v.domain == Domain::Plane) {
      index_ = Index4{x_, y_, 0, 0} - (v.domainView ? vector("sk_domain_origin") : Index4{});
      number_ = index_[1] * vector("sk_domain_shape")[0] + index_[0];
      return true;
    }
    number_ = y_ << integer("sk_domain_shift") | x_;
    index_ = unravel(number_, vector("sk_domain_stride"), v.domainRank);
    if (v.domain == Domain::Linear) return true;
    index_ = index_ - vector("sk_domain_origin");
    number_ = ravel(index_, vector("sk_domain_step"));
    return inside(index_, vector("sk_domain_shape"));
  }

  void findRun() {
    count_ = integer("sk_block_length");
    switch (pass_.variant.runs) {
      case Runs::OneBlock: first_ = number_ * integer("sk_fan"); break;
      case Runs::WholeBlocks: block_ = number_; return;
      case Runs::Split: {
        const int run = number_ / integer("sk_blocks");
        block_ = number_ - run * integer("sk_blocks");
        first_ = run * integer("sk_fan");
        break;
      }
    }
    count_ = std::min(integer("sk_fan"), integer("sk_block_length") - first_);
  }

  void startWalk() {
    const bool many = pass_.variant.runs != Runs::OneBlock;
    switch (pass_.variant.walk) {
      case Walk::Line: at_ = integer("sk_start") + block_ * integer("sk_block_length") + first_; return;
      case Walk::Partials: at_ = first_ * integer("sk_blocks") + block_; return;
      case Walk::Plane: {
        Index4 block{};
        const bool isReshaped = pass_.variant.reshaped;
        if (pass_.variant.runs == Runs::WholeBlocks && !isReshaped) block = index_;
        if (pass_.variant.runs == Runs::Split || isReshaped)
          block = unravel(block_, vector("sk_blocks_step"), 2);
        corner_ = vector("sk_origin") + block * vector("sk_block_shape");
        const int y = first_ / vector("sk_block_shape")[0];
        p_ = corner_ + Index4{first_ - y * vector("sk_block_shape")[0], y, 0, 0};
        return;
      }
      case Walk::Box: {
        const int axes = pass_.variant.axes;
        at_ = integer("sk_start");
        if (many) {
          at_ += ravel(unravel(block_, vector("sk_blocks_step"), axes) * vector("sk_block_shape"),
                       vector("sk_stride"));
        }
        p_ = unravel(first_, vector("sk_block_step"), axes);
        return;
      }
      case Walk::Index: {
        const int axes = pass_.variant.axes;
        if (many) corner_ = unravel(block_, vector("sk_blocks_step"), axes) * vector("sk_block_shape");
        p_ = unravel(first_, vector("sk_block_step"), axes);
        return;
      }
      case Walk::Rows:
      case Walk::PartialRows:
      case Walk::GroupedPartials:
      case Walk::Nothing: throw std::logic_error("walk");
    }
  }

  void step() {
    if (pass_.variant.walk == Walk::Plane) {
      ++p_[0];
      if (p_[0] == corner_[0] + vector("sk_block_shape")[0]) p_ = {corner_[0], p_[1] + 1, 0, 0};
    } else if (pass_.variant.walk == Walk::Box || pass_.variant.walk == Walk::Index) {
      ++p_[0];
      for (std::size_t axis = 0; axis + 1 < pass_.variant.axes; ++axis) {
        if (p_[axis] == vector("sk_block_shape")[axis]) p_[axis] = 0, ++p_[axis + 1];
      }
    }
  }

  const Name& fetch(int k) {
    switch (pass_.variant.walk) {
      case Walk::Plane: return element(p_[0], p_[1]);
      case Walk::Line: return numbered(at_ + k);
      case Walk::Partials: return numbered(at_ + k * integer("sk_blocks"));
      case Walk::Box: return numbered(at_ + ravel(p_, vector("sk_stride")));
      case Walk::Index: {
        const auto [x, y] = input_.texel(corner_ + p_);
        return element(x, y);
      }
      case Walk::Rows:
      case Walk::PartialRows:
      case Walk::GroupedPartials:
      case Walk::Nothing: break;
    }
    throw std::logic_error("walk");
  }

  const Name& numbered(int number) {
    const int shift = integer("sk_shift");
    return element(number & ((1 << shift) - 1), number >> shift);
  }

  const Name& element(int x, int y) {
    const std::optional<Name>& texel = source_.at(x, y);
    if (!texel) throw std::logic_error("a texel is read that holds no element");
    return *texel;
  }

  const ReducePass& pass_;
  Texture& source_;
  const Region& input_;
  int x_, y_;
  Index4 index_{}, corner_{}, p_{};
  int number_ = 0, block_ = 0, first_ = 0, count_ = 0, at_ = 0;
};

constexpr std::int32_t mostLayers = 8;

/// Layers are equivalent to one tall texture.
std::pair<int, int> sizeOf(const TextureShape& texture) {
  return {texture.width, texture.height * std::max(texture.layers, 1)};
}

/// Lays a stream out as the runtime does; nullopt if it does not fit in one texture.
std::optional<Region> layOut(const Index4& extent, int rank, const Index4& before, const Index4& after,
                             int limit) {
  const Index4 whole = before + extent + after;
  Region region{{.view = whole != extent, .origin = before, .extent = extent}, whole[0], whole[1]};
  if (rank <= 2 && whole[0] <= limit && whole[1] <= limit) return region;
  RegionLayout& regionLayout = region.regionLayout;
  const std::optional<TextureShape> texture = linearTexture(elements(whole), {limit, mostLayers});
  if (!texture) return {};
  const RegionLayout linear = linearLayout(elements(whole), *texture);
  regionLayout.linear = true;
  regionLayout.layered = linear.layered;
  regionLayout.stride = stridesOf(whole);
  regionLayout.shift = linear.shift;
  std::tie(region.width, region.height) = sizeOf(*texture);
  return region;
}

template <class Visit>
void forEach(const Index4& extent, Visit visit) {
  Index4 i{};
  for (i[3] = 0; i[3] < extent[3]; ++i[3]) {
    for (i[2] = 0; i[2] < extent[2]; ++i[2]) {
      for (i[1] = 0; i[1] < extent[1]; ++i[1]) {
        for (i[0] = 0; i[0] < extent[0]; ++i[0]) visit(Index4(i));
      }
    }
  }
}

void draw(const ReducePass& pass, Texture& source, const Region& input, Texture& target) {
  std::set<std::pair<int, int>> drawn;
  for (const Rect& rect : pass.draws) {
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      for (int x = rect.x; x < rect.x + rect.width; ++x) {
        if (!drawn.insert({x, y}).second) throw std::logic_error("a texel is drawn twice");
        if (auto value = Fragment(pass, source, input, x, y).run()) target.at(x, y) = std::move(value);
      }
    }
  }
}

/// Executes passes as the runtime does.
Texture execute(const std::vector<ReducePass>& passes, Texture source, const Region& input,
                const Region& result) {
  for (const ReducePass& pass : passes) {
    const auto [width, height] =
        pass.toResult ? std::pair(result.width, result.height) : sizeOf(pass.texture);
    Texture target(width, height);
    draw(pass, source, input, target);
    source = std::move(target);
  }
  return source;
}

/// `length` is that of a block. Passes by rows may exceed the minimum by one, because runs end with their
/// row; groups fold more.
void checkSchedule(const std::vector<ReducePass>& passes, const ReduceLimits& limits, std::int64_t length) {
  std::size_t needed = 1;
  for (std::int64_t left = length; left > limits.fanIn; left = (left + limits.fanIn - 1) / limits.fanIn)
    ++needed;
  const bool isByRows = passes.front().variant.walk == Walk::Rows;
  if (limits.grouped) {
    REQUIRE(passes.size() <= needed + isByRows);
  } else {
    REQUIRE((passes.size() == needed || (isByRows && passes.size() <= needed + 2)));
  }
  std::set<ReduceVariant> programs;
  for (const ReducePass& pass : passes) {
    programs.insert(pass.variant);
    REQUIRE(pass.toResult == (&pass == &passes.back()));
    REQUIRE((pass.texture.width <= limits.texture.size && pass.texture.height <= limits.texture.size));
  }
  REQUIRE(programs.size() <= (passes.front().variant.domainLayered || limits.grouped ? 4 : 3));
}

/// Reduces to `blocks` and compares every element of the result.
void check(const Region& input, const Region& result, const ReduceLimits& limits, const Index4& blocks,
           bool byIndex = false, bool inAnyOrder = false) {
  const Index4& extent = input.regionLayout.extent;
  Texture source(input.width, input.height);
  char16_t name = 0;
  forEach(extent, [&](const Index4& i) {
    const auto [x, y] = input.texel(i);
    std::optional<Name>& texel = source.at(x, y);
    texel = texel.value_or(Name()) + Name(1, ++name);
  });
  std::vector<Name> expected(static_cast<std::size_t>(elements(blocks)));
  name = 0;
  forEach(extent, [&](const Index4& i) {
    const Index4 block = {i[0] / (extent[0] / blocks[0]), i[1] / (extent[1] / blocks[1]),
                          i[2] / (extent[2] / blocks[2]), i[3] / (extent[3] / blocks[3])};
    expected[static_cast<std::size_t>(ravel(block, stridesOf(blocks)))] += ++name;
  });

  const auto passes = planReduction(input.regionLayout, result.regionLayout, limits,
                                    {.blocks = blocks,
                                     .byIndex = byIndex,
                                     .byTexel = input.regionLayout.packed,
                                     .inAnyOrder = inAnyOrder,
                                     .inGroups = inAnyOrder});
  checkSchedule(passes, limits, elements(extent) / elements(blocks));
  Texture output = execute(passes, std::move(source), input, result);
  std::size_t written = 0;
  forEach(result.regionLayout.extent, [&](const Index4& b) {
    const auto [x, y] = result.texel(b);
    auto value = output.at(x, y);
    if (value && inAnyOrder) std::ranges::sort(*value);
    if (!value || *value != expected[written++]) FAIL("block " << written - 1 << " is wrong");
  });
  const auto all = std::ranges::count_if(output.texels, [](const auto& texel) { return texel.has_value(); });
  REQUIRE(static_cast<std::size_t>(all) == written);
}

std::vector<std::int32_t> divisors(std::int32_t n) {
  std::vector<std::int32_t> result;
  for (std::int32_t d = 1; d <= n; ++d) {
    if (n % d == 0) result.push_back(d);
  }
  return result;
}

constexpr Index4 none{};

/// Tests every block shape, between whole streams, views and both; and reductions to a value.
void checkShape(const Index4& extent, int rank, const ReduceLimits& limits) {
  CAPTURE(extent[0], extent[1], extent[2], extent[3], rank, limits.texture.size, limits.fanIn);
  Index4 before{}, after{};
  for (std::size_t d = 0; d < static_cast<std::size_t>(rank); ++d) {
    before[d] = d % 2 == 0 ? 2 : 1;
    after[d] = d % 2 == 0 ? 0 : 3;
  }
  Index4 rowsBefore{};  // a view of whole rows, planes, ...: its elements are consecutive
  rowsBefore[static_cast<std::size_t>(rank - 1)] = 3;
  const Region value{valueLayout(), 1, 1};
  const auto inputs = {layOut(extent, rank, none, none, limits.texture.size),
                       layOut(extent, rank, before, after, limits.texture.size),
                       layOut(extent, rank, rowsBefore, none, limits.texture.size)};
  for (const auto& input : inputs) {
    if (input) check(*input, value, limits, {1, 1, 1, 1});
  }
  for (const auto x : divisors(extent[0])) {
    for (const auto y : divisors(extent[1])) {
      for (const auto z : divisors(extent[2])) {
        for (const auto w : divisors(extent[3])) {
          const Index4 blocks = {x, y, z, w};
          for (const Index4& margin : {none, before}) {
            const auto result = layOut(blocks, rank, margin, none, limits.texture.size);
            for (const auto& input : inputs) {
              if (input && result) check(*input, *result, limits, blocks, margin != none);
            }
          }
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("reductions of rank 1 keep the order, for every length to 70") {
  for (const int limit : {8, 64}) {
    for (const int fanIn : {2, 3, 32}) {
      for (int n = 1; n <= 70; ++n) checkShape({n, 1, 1, 1}, 1, {{limit, mostLayers}, fanIn});
    }
  }
}

TEST_CASE("reductions of long streams keep the order") {
  for (const int n : {127, 128, 1000, 1021, 1024, 1025, 3600, 4093})
    checkShape({n, 1, 1, 1}, 1, {{64, mostLayers}, 16});
}

TEST_CASE("reductions of streams in layers keep the order") {
  for (const int n : {65, 200, 509}) checkShape({n, 1, 1, 1}, 1, {{8, mostLayers}, 3});
  checkShape({12, 36, 1, 1}, 2, {{8, mostLayers}, 4});
  checkShape({8, 6, 10, 1}, 3, {{8, mostLayers}, 5});
  CHECK(planReduction(linearLayout(500, {8, 8, 8}), valueLayout(), {{8, mostLayers}, 2})
            .front()
            .variant.domainLayered);
}

TEST_CASE("reductions of rank 2 keep the order") {
  const auto lengths = {1, 2, 3, 4, 6, 7, 8, 9, 13, 16, 31, 36, 64, 67};
  for (const int height : lengths) {
    for (const int width : lengths) {
      checkShape({width, height, 1, 1}, 2, {{64, mostLayers}, 4});
      if (width * height <= 64) checkShape({width, height, 1, 1}, 2, {{8, mostLayers}, 3});
    }
  }
}

/// A stream of packed elements.
std::optional<Region> packed(const Index4& extent, int rank, const Index4& before, const Index4& after,
                             int limit) {
  const auto texels = [](Index4 index) {
    index[0] /= lanes;
    return index;
  };
  std::optional<Region> region = layOut(texels(extent), rank, texels(before), texels(after), limit);
  if (!region) return {};
  region->regionLayout.packed = true;
  region->regionLayout.extent = extent;
  region->regionLayout.origin = before;
  if (region->regionLayout.linear) region->regionLayout.stride = stridesOf(before + extent + after);
  return region;
}

TEST_CASE("reductions of packed streams keep the order") {
  for (const int height : {1, 2, 3, 5, 8, 16}) {
    for (const int width : {4, 8, 12, 20, 64, 72}) {
      for (const int limit : {8, 64}) {
        for (const bool grouped : {false, true}) {
          const Index4 extent{width, height, 1, 1};
          CAPTURE(width, height, limit, grouped);
          const ReduceLimits limits{{limit, mostLayers}, 16, grouped, 64};
          for (const Index4& before : {none, Index4{8, 1, 0, 0}}) {
            if (const auto input = packed(extent, 2, before, none, limit)) {
              check(*input, {valueLayout(), 1, 1}, limits, {1, 1, 1, 1});
              check(*input, {valueLayout(), 1, 1}, limits, {1, 1, 1, 1}, false, true);
              const auto rows = layOut({1, height, 1, 1}, 2, none, none, limit);
              if (rows) check(*input, *rows, limits, {1, height, 1, 1});
            }
          }
        }
      }
    }
  }
}

TEST_CASE("long runs, and rows that end early, fold all") {
  const auto checkAll = [](const std::optional<Region>& input) {
    for (const std::int32_t longRun : {0, 16})
      check(*input, {valueLayout(), 1, 1}, {{64, mostLayers}, 16, false, 256, longRun}, {1, 1, 1, 1}, false,
            true);
  };
  for (const int n : {1, 9, 64, 65, 72, 511, 512, 520, 1000, 1021, 1024, 1025, 2049, 4000}) {
    for (const int before : {0, 8, 64}) {
      checkAll(layOut({n, 1, 1, 1}, 1, {before, 0, 0, 0}, none, 64));
      checkAll(packed({4 * n, 1, 1, 1}, 1, {before, 0, 0, 0}, none, 64));
    }
    if (n < 73) checkAll(packed({4 * 5, n, 1, 1}, 2, none, none, 128));
  }
}

TEST_CASE("work groups keep the order, or fold all") {
  for (const int n : {1, 2, 33, 1000, 4097, 9000}) {
    for (const int rank : {1, 2}) {
      const Index4 extent = rank == 1 ? Index4{n, 1, 1, 1} : Index4{(n + 6) / 7, 7, 1, 1};
      const auto input = layOut(extent, rank, none, none, 2048);
      for (const bool inAnyOrder : {false, true}) {
        CAPTURE(n, rank, inAnyOrder);
        check(*input, {valueLayout(), 1, 1}, {{2048, mostLayers}, 4, true}, {1, 1, 1, 1}, false, inAnyOrder);
      }
    }
  }
}

TEST_CASE("reductions of rank 3 keep the order") {
  const auto lengths = {1, 2, 3, 5, 6, 8};
  for (const int depth : lengths) {
    for (const int height : lengths) {
      for (const int width : lengths) checkShape({width, height, depth, 1}, 3, {{64, mostLayers}, 5});
    }
  }
}

TEST_CASE("reductions of rank 4 keep the order") {
  const auto lengths = {1, 2, 3, 4};
  for (const int duration : lengths) {
    for (const int depth : lengths) {
      for (const int height : lengths) {
        for (const int width : lengths)
          checkShape({width, height, depth, duration}, 4, {{64, mostLayers}, 3});
      }
    }
  }
}

TEST_CASE("results of other dimensions than the blocks keep the order") {
  for (const auto& [extent, blocks] : {std::pair(Index4{12, 10, 1, 1}, Index4{1, 5, 1, 1}),
                                       std::pair(Index4{12, 10, 1, 1}, Index4{1, 10, 1, 1}),
                                       std::pair(Index4{6, 4, 5, 1}, Index4{3, 1, 5, 1}),
                                       std::pair(Index4{6, 4, 5, 3}, Index4{1, 2, 1, 3})}) {
    Index4 reshaped{1, 1, 1, 1};
    int rank = 0;
    for (const std::int32_t count : blocks) {
      if (count > 1) reshaped[static_cast<std::size_t>(rank++)] = count;
    }
    for (const int limit : {8, 64}) {
      const auto input = layOut(extent, 4, none, none, limit);
      const auto plane = layOut(extent, 2, none, none, limit);
      for (const Index4& margin : {none, Index4{2, 0, 0, 0}}) {
        const auto result = layOut(reshaped, rank, margin, none, limit);
        for (const bool byIndex : {false, true}) {
          if (input) check(*input, *result, {limit, 4}, blocks, byIndex);
          if (plane && extent[2] == 1) check(*plane, *result, {limit, 64}, blocks, byIndex);
        }
      }
    }
  }
}
