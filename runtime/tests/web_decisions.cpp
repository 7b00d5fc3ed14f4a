// SPDX-License-Identifier: MIT
//
// Prints decisions of this runtime as JSON, for streams that are whole: how they lie in textures, which program a kernel needs, and the
// passes of reductions with their uniforms. tests/web/decisions replays them in TypeScript, so that runtime/web decides likewise.
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "assemble/append/histo_pyramid.hpp"
#include "assemble/assemble.hpp"
#include "assemble/reduce/reduce_plan.hpp"
#include "assemble/reduce/scan_plan.hpp"
#include "call/box.hpp"
#include "gl_device/memory/layout.hpp"
#include "gl_device/program/variant.hpp"
#include "sk/error.hpp"

namespace {

using sk::Shape;
using sk::assemble::Index4;
using sk::assemble::ReducePass;
using sk::assemble::RegionLayout;
using sk::program::Parameter;
using sk::program::Role;

std::mt19937 generator(1);
std::int64_t below(std::int64_t n) {
  return std::uniform_int_distribution<std::int64_t>(0, n - 1)(generator);
}

/// Extents of every size: tiny ones, those near powers of two, and large ones.
std::int64_t extent(int rank) {
  const std::int64_t largest = rank == 1 ? 3000000 : rank == 2 ? 3000 : rank == 3 ? 120 : 24;
  switch (below(4)) {
    case 0: return 1 + below(9);
    case 1: return std::min(largest, (std::int64_t{1} << below(12)) + below(3));
    case 2: return std::min(largest, 4 + 4 * below(200));
    default: return 1 + below(largest);
  }
}

Shape shapeOf(int rank) {
  switch (rank) {
    case 1: return {extent(1)};
    case 2: return {extent(2), extent(2)};
    case 3: return {extent(3), extent(3), extent(3)};
    default: return {extent(4), extent(4), extent(4), extent(4)};
  }
}

std::string text(const Shape& shape) {
  std::vector<std::int64_t> extents;
  for (int d = 0; d < shape.rank(); ++d) extents.push_back(shape[d]);
  return fmt::format("[{}]", fmt::join(extents, ","));
}
std::string text(const Index4& index) { return fmt::format("[{}]", fmt::join(index, ",")); }
std::string text(const std::vector<sk::assemble::Rect>& rects) {
  std::vector<std::string> items;
  for (const auto& [x, y, width, height] : rects)
    items.push_back(fmt::format("[{},{},{},{}]", x, y, width, height));
  return fmt::format("[{}]", fmt::join(items, ","));
}

/// A stream: its shape, and whether it is packed.
struct Lie {
  Shape shape;
  bool packed;

  explicit Lie(int rank) : shape(shapeOf(rank)), packed(below(2) == 0 && sk::mayPack(shape)) {}
  std::string text() const { return fmt::format(R"({{"shape":{},"packed":{}}})", ::text(shape), packed); }
};

sk::assemble::TextureLimits limits(std::int32_t size) {
  return {size, 0};
}  // browsers have no layers of streams

/// Streams of one dimension are always linearised in browsers, as lists are here.
sk::Layout layoutOf(const Lie& lie, std::int32_t size = 8192) {
  if (lie.shape.rank() != 1) return sk::layoutOf(lie.shape, limits(size), lie.packed);
  const std::int64_t count = lie.shape[0];
  sk::Layout layout = sk::listLayout(lie.packed ? count / sk::assemble::lanes : count, limits(size));
  layout.whole.packed = lie.packed;
  layout.whole.extent = sk::xFirst(lie.shape);
  layout.whole.stride = sk::assemble::stridesOf(layout.whole.extent);
  return layout;
}

std::vector<std::string> layouts() {
  std::vector<std::string> cases;
  for (int i = 0; i < 600; ++i) {
    const Lie lie(1 + i % 4);
    const std::int32_t size = i % 3 == 0 ? 64 : 8192;
    std::string result = "null";
    try {
      const sk::Layout layout = layoutOf(lie, size);
      const RegionLayout& whole = layout.whole;
      result = fmt::format(
          R"({{"linear":{},"packed":{},"extent":{},"stride":{},"shift":{},"width":{},"height":{},"draws":{}}})",
          whole.linear, whole.packed, text(whole.extent), text(whole.stride), whole.shift,
          layout.texture.width, layout.texture.height, text(layout.draws));
    } catch (const sk::Error&) {
    }  // too large
    cases.push_back(fmt::format(R"({{"stream":{},"textureSize":{},"layout":{}}})", lie.text(), size, result));
  }
  return cases;
}

/// A pass as JSON.
std::string text(const ReducePass& pass) {
  constexpr const char* walks[] = {"line",        "plane",           "box",    "index", "rows", "partials",
                                   "partialRows", "groupedPartials", "nothing"};
  constexpr const char* runs[] = {"", " whole", " split"};
  constexpr const char* scans[] = {"", " folds", " inclusive", " exclusive"};
  const sk::assemble::ReduceVariant& v = pass.variant;
  std::vector<std::string> uniforms;
  for (const auto& [name, isVector, value] : pass.uniforms)
    uniforms.push_back(fmt::format(R"("{}":{})", name, isVector ? text(value) : std::to_string(value[0])));
  return fmt::format(
      R"({{"walk":"{}","runs":"{}","toPlane":{},"axes":{},"run":{},"column":{},"packed":{},"scan":"{}","carried":{},)"
      R"("toResult":{},"width":{},"height":{},"draws":{},"uniforms":{{{}}}}})",
      walks[static_cast<std::size_t>(v.walk)], runs[static_cast<std::size_t>(v.runs)],
      v.domain == sk::assemble::Domain::Plane, v.axes, v.run, v.column, v.packed,
      scans[static_cast<std::size_t>(v.scan)], v.carried, pass.toResult, pass.texture.width,
      pass.texture.height, text(pass.draws), fmt::join(uniforms, ","));
}

std::string text(const std::vector<ReducePass>& passes) {
  std::vector<std::string> items;
  for (const ReducePass& pass : passes) items.push_back(text(pass));
  return fmt::format("[{}]", fmt::join(items, ","));
}

std::vector<std::string> reductions() {
  std::vector<std::string> cases;
  for (int i = 0; i < 600; ++i) {
    const Lie lie(1 + i % 4);
    const bool byIndex = below(4) == 0 && !lie.packed;
    const bool inAnyOrder = below(2) == 0;
    const bool isKnown = below(2) == 0;
    const sk::Layout layout = layoutOf(lie);
    sk::assemble::ReduceLimits most{.texture = limits(8192)};
    if (!isKnown) most.knownRuns = std::numeric_limits<std::int32_t>::max();
    const sk::assemble::Division division{
        .blocks = {1, 1, 1, 1}, .byIndex = byIndex, .byTexel = lie.packed, .inAnyOrder = inAnyOrder};
    cases.push_back(fmt::format(
        R"({{"stream":{},"byIndex":{},"inAnyOrder":{},"knownRuns":{},"passes":{}}})", lie.text(), byIndex,
        inAnyOrder, isKnown, text(planReduction(layout.whole, sk::assemble::valueLayout(), most, division))));
  }
  return cases;
}

/// A divisor of n.
std::int64_t divisorOf(std::int64_t n) {
  const std::int64_t most = 1 + below(std::min<std::int64_t>(n, 100));
  for (std::int64_t divisor = most; divisor > 1; --divisor) {
    if (n % divisor == 0) return below(2) == 0 ? divisor : n / divisor;
  }
  return below(2) == 0 ? 1 : n;
}

/// Reductions to streams: the grid of blocks that a result's shape means, and the passes of those that mean one.
std::vector<std::string> blocks() {
  std::vector<std::string> cases;
  for (int i = 0; i < 500; ++i) {
    Lie lie(1 + i % 4);
    lie.packed = false;
    std::vector<std::int64_t> extents;
    for (int d = 0; d < lie.shape.rank(); ++d) {
      if (below(4) != 0 || (extents.empty() && d + 1 == lie.shape.rank()))
        extents.push_back(below(10) == 0 ? 1 + below(5) : divisorOf(lie.shape[d]));
    }
    Lie result(static_cast<int>(extents.size()));
    result.packed = false;
    for (int d = 0; d < result.shape.rank(); ++d)
      result.shape = result.shape.with(d, extents[static_cast<std::size_t>(d)]);
    std::vector<std::string> grids;
    const std::vector<Shape> found = sk::blockGrids(lie.shape, result.shape);
    for (const Shape& grid : found) grids.push_back(text(grid));
    std::string passes = "null";
    if (found.size() == 1 && found[0].size() > 1) {
      const sk::assemble::Division division{.blocks = sk::xFirst(found[0]), .byIndex = true};
      passes = text(
          planReduction(layoutOf(lie).whole, layoutOf(result).whole, {.texture = limits(8192)}, division));
    }
    cases.push_back(fmt::format(R"({{"stream":{},"result":{},"grids":[{}],"passes":{}}})", lie.text(),
                                result.text(), fmt::join(grids, ","), passes));
  }
  return cases;
}

std::vector<std::string> scans() {
  std::vector<std::string> cases;
  for (int i = 0; i < 400; ++i) {
    Lie lie(1 + i % 4);
    lie.packed = false;
    const RegionLayout elements = layoutOf(lie).whole;
    const bool byIndex = below(3) == 0, isExclusive = below(2) == 0;
    const int along = static_cast<int>(below(lie.shape.rank() + 1)) - 1;
    const Shape grid = along < 0 ? sk::oneBlock(lie.shape) : lie.shape.with(along, 1);
    const sk::assemble::ReduceLimits most{.texture = limits(8192), .fanIn = sk::assemble::scanRun};
    const sk::assemble::ScanPlan plan =
        planScan(elements, elements, most, sk::assemble::linesOf(elements.extent, sk::xFirst(grid)),
                 {.byIndex = byIndex}, isExclusive);
    cases.push_back(
        fmt::format(R"({{"stream":{},"byIndex":{},"exclusive":{},"along":{},"folds":{},"scans":{}}})",
                    lie.text(), byIndex, isExclusive, along, text(plan.folds), text(plan.scans)));
  }
  return cases;
}

/// Calls of a kernel with inputs, and gathers of each rank that read neighbours.
std::vector<std::string> variants() {
  static constexpr sk::program::Field field{"", sk::program::Scalar::Float, 1, 0};
  static constexpr sk::program::Element element{"float", "float", 4, {&field, 1}};
  constexpr const char* addressings[] = {"aligned", "plane", "linear", "layered", "rows"};
  std::vector<std::string> cases;
  for (int i = 0; i < 600; ++i) {
    const int rank = 1 + i % 4;
    const Lie domain(rank);
    std::vector<Parameter> parameters = {
        {.name = "x", .symbol = "x", .role = Role::Input, .element = &element}};
    std::vector<Lie> lies = {domain};
    lies[0].packed = below(2) == 0 && sk::mayPack(domain.shape);
    for (std::uint8_t r = 1; r <= 3; ++r) {
      parameters.push_back({.name = std::string_view("abc").substr(r - 1u, 1),
                            .symbol = "a",
                            .role = Role::Gather,
                            .element = &element,
                            .rank = r,
                            .usesNear = true,
                            .reach = static_cast<std::int32_t>(below(3))});
      Lie lie(r);
      if (r == rank && below(2) == 0) lie = domain;
      lies.push_back(lie);
    }
    parameters.push_back({.name = "r", .symbol = "r", .role = Role::Output, .element = &element});
    lies.push_back(domain);
    const sk::program::Kernel kernel{
        .name = "k", .entry = "k", .declarations = {}, .body = {}, .parameters = parameters, .sources = {}};
    std::vector<sk::Operand> operands;
    std::vector<std::string> streams, accesses;
    for (const Lie& lie : lies) {
      operands.push_back({.regionLayout = layoutOf(lie).whole});
      streams.push_back(lie.text());
    }
    const sk::assemble::Variant variant = sk::chooseVariant(kernel, operands, operands.back().regionLayout);
    for (std::size_t p = 0; p + 1 < lies.size(); ++p) {
      const sk::assemble::StreamAccess& access = variant.access[p];
      accesses.push_back(fmt::format(R"("{}{}{}")", addressings[static_cast<std::size_t>(access.addressing)],
                                     access.packed ? " packed" : "", access.nearby ? " nearby" : ""));
    }
    std::vector<std::int32_t> reaches;
    for (const Parameter& parameter : parameters) reaches.push_back(parameter.reach);
    cases.push_back(fmt::format(
        R"({{"streams":[{}],"reaches":[{}],"linear":{},"rank":{},"packed":{},"access":[{}]}})",
        fmt::join(streams, ","), fmt::join(reaches, ","), variant.domain == sk::assemble::Domain::Linear,
        variant.domainRank, variant.domainPacked, fmt::join(accesses, ",")));
  }
  return cases;
}

std::vector<std::string> pyramids() {
  std::vector<std::string> cases;
  for (int i = 0; i < 300; ++i) {
    const auto count = static_cast<std::int32_t>(i < 20 ? 1 + i : 1 + below(std::int64_t{1} << (1 + i % 26)));
    const sk::assemble::PyramidPlan plan = sk::assemble::planPyramid(count, limits(8192));
    std::vector<std::string> levels;
    for (const auto& [children, row, draws] : plan.levels)
      levels.push_back(fmt::format(R"({{"children":{},"row":{},"draws":{}}})", children, row, text(draws)));
    cases.push_back(fmt::format(R"({{"count":{},"width":{},"oddRows":{},"evenRows":{},"levels":[{}]}})",
                                count, plan.odd.width, plan.odd.height, plan.even.height,
                                fmt::join(levels, ",")));
  }
  return cases;
}

/// The texel of an element of a region, as RegionLayout says.
std::pair<std::int32_t, std::int32_t> texelOf(const RegionLayout& region, const Index4& index) {
  const auto at = [&](std::size_t d) { return index[d] * (region.strided ? region.stride[d] : 1); };
  if (!region.linear && !region.numbered) return {region.origin[0] + at(0), region.origin[1] + at(1)};
  std::int32_t number = region.strided ? region.origin[0] : 0;
  for (std::size_t d = 0; d < index.size(); ++d)
    number += region.strided ? at(d) : (region.origin[d] + index[d]) * region.stride[d];
  if (region.numbered) return {number % region.shift, number / region.shift};
  return {number & ((1 << region.shift) - 1), number >> region.shift};
}

/// Views: where some of their elements lie and, of boxes, what a pass over them draws.
std::vector<std::string> views() {
  std::vector<std::string> cases;
  for (int i = 0; i < 400; ++i) {
    const int rank = 1 + i % 4;
    Lie whole(rank);
    whole.packed = false;
    sk::Index begin = sk::Index::origin(rank), steps = begin, strides = begin;
    Shape shape = whole.shape;
    bool isBox = true;
    std::int64_t first = 0, stride = 1;
    for (int d = rank; d-- > 0; stride *= whole.shape[d]) {
      begin[d] = below(whole.shape[d]);
      steps[d] = i % 2 == 0 ? 1 : 1 + below(3);
      shape = shape.with(d, 1 + below((whole.shape[d] - 1 - begin[d]) / steps[d] + 1));
      if (shape[d] == 1) steps[d] = 1;
      isBox = isBox && steps[d] == 1;
      strides[d] = steps[d] * stride;
      first += begin[d] * stride;
    }
    const sk::StreamRegion region = isBox ? sk::StreamRegion{nullptr, begin, shape, {}, 0}
                                          : sk::StreamRegion{nullptr, {}, shape, strides, first};
    const RegionLayout layout = regionLayoutOf(region, layoutOf(whole));
    std::vector<std::string> samples;
    for (int k = 0; k < 6; ++k) {
      Index4 index{0, 0, 0, 0};
      for (std::size_t d = 0; d < static_cast<std::size_t>(rank); ++d)
        index[d] = k == 0 ? layout.extent[d] - 1 : static_cast<std::int32_t>(below(layout.extent[d]));
      const auto [x, y] = texelOf(layout, index);
      samples.push_back(fmt::format("[{},[{},{}]]", text(index), x, y));
    }
    const auto listed = [&](const sk::Index& index) {
      std::vector<std::int64_t> numbers;
      for (int d = 0; d < rank; ++d) numbers.push_back(index[d]);
      return fmt::format("[{}]", fmt::join(numbers, ","));
    };
    cases.push_back(
        fmt::format(R"({{"stream":{},"begin":{},"shape":{},"steps":{},"texels":[{}],"draws":{}}})",
                    whole.text(), listed(begin), text(shape), listed(steps), fmt::join(samples, ","),
                    isBox ? text(sk::assemble::drawnTexels(layout)) : "null"));
  }
  return cases;
}

}  // namespace

int main() {
  fmt::print(
      "{{\"layouts\":[\n{}],\n\"reductions\":[\n{}],\n\"blocks\":[\n{}],\n\"scans\":[\n{}],\n\"variants\":["
      "\n{}],\n\"views\":[\n{}],\n\"pyramids\":[\n{}]}}\n",
      fmt::join(layouts(), ",\n"), fmt::join(reductions(), ",\n"), fmt::join(blocks(), ",\n"),
      fmt::join(scans(), ",\n"), fmt::join(variants(), ",\n"), fmt::join(views(), ",\n"),
      fmt::join(pyramids(), ",\n"));
}
