// SPDX-License-Identifier: MIT
//
// Promises: a stencil whose work groups share texels has the same results as loops on the host, wherever the domain
// ends in a work group, and if it is a part of a whole; so has one that also folds its results in the same dispatch, with
// shared texels or without. Runs on a software renderer, which by default does not share texels.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "call/resolved_call.hpp"
#include "device/stream_state.hpp"
#include "gl/open_context.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/types.hpp"

namespace sk {
namespace {

using program::Boundary;
using program::Kernel;
using program::Parameter;
using program::Role;

constexpr const program::Element& floats = ElementTraits<float>::element();

/// A weighted sum of neighbours within `reach`, at most five per row: drivers compile 81 of them too slowly.
std::string bodyOf(int reach) {
  std::string body = "void weigh(out float r) {\n  r = 0.0;\n";
  int weight = 1;
  const int step = reach > 2 ? reach / 2 : 1;
  for (int y = -reach; y <= reach; y += step) {
    for (int x = -reach; x <= reach; x += step) {
      body += "  r += " + std::to_string(weight++) + ".0 * sk_near_a(ivec2(" + std::to_string(x) + ", " +
              std::to_string(y) + "));\n";
    }
  }
  return body + "}\n";
}

/// Must outlive the devices that run it, which identify it by its address.
struct Weigh {
  Weigh(Boundary boundary, int reach)
      : body(bodyOf(reach)),
        halo{{{0, program::Reach::Kind::Near, {reach}, {reach}},
              {1, program::Reach::Kind::Near, {reach}, {reach}}}},
        parameters{{{.name = "a",
                     .symbol = "a",
                     .role = Role::Gather,
                     .element = &floats,
                     .rank = 2,
                     .boundary = boundary,
                     .border = "-7.0",
                     .usesNear = true,
                     .reach = reach,
                     .halo = halo,
                     .haloShapes = 1},
                    {.name = "r", .symbol = "r", .role = Role::Output, .element = &floats}}},
        kernel{.name = "weigh",
               .entry = "weigh",
               .declarations = {},
               .body = body,
               .parameters = parameters,
               .sources = {}} {}
  Weigh(const Weigh&) = delete;
  Weigh& operator=(const Weigh&) = delete;

  std::string body;
  std::array<program::Reach, 2> halo;
  std::array<Parameter, 2> parameters;
  Kernel kernel;
};

/// The same, and a sum of what it stores, modulo 16.
struct WeighAndFold {
  WeighAndFold(Boundary boundary, int reach)
      : weigh(boundary, reach),
        body(weigh.body +
             "void fold(out float r, inout float total) {\n  weigh(r);\n  total += mod(r, 16.0);\n}\n"),
        parameters{{weigh.parameters[0], weigh.parameters[1], accumulator}},
        reduction{.fold = {.name = "fold",
                           .entry = "fold",
                           .declarations = {},
                           .body = body,
                           .parameters = parameters,
                           .sources = {}},
                  .combine = {.name = "add",
                              .entry = "add",
                              .declarations = {},
                              .body = combining,
                              .parameters = combined,
                              .sources = {}},
                  .combineOperands = {},
                  .addition = combining,
                  .seeded = false,
                  .commutative = true} {}
  WeighAndFold(const WeighAndFold&) = delete;
  WeighAndFold& operator=(const WeighAndFold&) = delete;

  static constexpr std::string_view combining =
      "void add(float part, inout float total) { total += part; }\n";
  static constexpr Parameter accumulator{
      .name = "total", .symbol = "total", .role = Role::Accumulator, .element = &floats, .identity = "0.0"};
  static constexpr std::array<Parameter, 2> combined{
      {{.name = "part", .symbol = "part", .role = Role::Input, .element = &floats}, accumulator}};

  Weigh weigh;
  std::string body;
  std::array<Parameter, 3> parameters;
  program::Reduction reduction;
};

std::vector<float> numbersOf(const Shape& shape) {
  std::vector<float> values(static_cast<std::size_t>(shape.size()));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i * 37 % 101);
  return values;
}

std::vector<float> weighed(GlDevice& device, const Kernel& kernel, const Shape& shape) {
  std::vector<float> values = numbersOf(shape);
  const auto a = device.createStream(floats, shape, Storage::Single);
  const auto r = device.createStream(floats, shape, Storage::Single);
  detail::write(detail::wholeRegion(a.get()), values.data(), values.size());
  const std::array arguments{Argument{.region = detail::wholeRegion(a.get())},
                             Argument{.region = detail::wholeRegion(r.get())}};
  device.runUnchecked(kernel, arguments, {.target = Target::Compute});
  detail::read(detail::wholeRegion(r.get()), values.data(), values.size());
  return values;
}

/// The rows from `begin` to `end` (exclusive) of what weighed() gives, from a part of the elements: `halo` rows more above and
/// below, without those beyond the ends unless `wraps`.
std::vector<float> weighedInPart(GlDevice& device, const Kernel& kernel, const Shape& whole,
                                 std::int64_t begin, std::int64_t end, std::int64_t halo, bool wraps) {
  const std::vector<float> all = numbersOf(whole);
  const std::int64_t width = whole[1];
  const std::int64_t first = wraps ? begin - halo : std::max<std::int64_t>(begin - halo, 0);
  const std::int64_t last = wraps ? end + halo : std::min(end + halo, whole[0]);
  std::vector<float> held, values(static_cast<std::size_t>((end - begin) * width));
  for (std::int64_t row = first; row < last; ++row) {
    const auto from = all.begin() + (row + whole[0]) % whole[0] * width;
    held.insert(held.end(), from, from + width);
  }
  const auto a = device.createStream(floats, {last - first, width}, Storage::Single);
  const auto r = device.createStream(floats, {end - begin, width}, Storage::Single);
  detail::write(detail::wholeRegion(a.get()), held.data(), held.size());
  std::array arguments{Argument{.region = detail::wholeRegion(a.get())},
                       Argument{.region = detail::wholeRegion(r.get())}};
  arguments[0].region.placement = {{first, 0}, whole};
  arguments[1].region.placement = {{begin, 0}, whole};
  const ResolvedCall call{kernel,
                          arguments,
                          {.target = Target::Compute},
                          {},
                          {end - begin, width},
                          nullptr,
                          arguments[1].region.placement};
  device.run(call);
  detail::read(detail::wholeRegion(r.get()), values.data(), values.size());
  return values;
}

/// What weighed() gives, and the sum.
std::pair<std::vector<float>, float> folded(GlDevice& device, const program::Reduction& reduction,
                                            const Shape& shape) {
  std::vector<float> values = numbersOf(shape);
  const auto a = device.createStream(floats, shape, Storage::Single);
  const auto r = device.createStream(floats, shape, Storage::Single);
  const auto total = device.createStream(floats, {1, 1}, Storage::Single);
  detail::write(detail::wholeRegion(a.get()), values.data(), values.size());
  const std::array arguments{Argument{.region = detail::wholeRegion(a.get())},
                             Argument{.region = detail::wholeRegion(r.get())},
                             Argument{.region = detail::wholeRegion(total.get())}};
  ResolvedReduction call{device, reduction, arguments, shape, {1, 1}};
  call.options.target = Target::Compute;
  CHECK(device.foldsBesideOutputs(call));
  device.reduce(call);
  float sum = 0;
  detail::read(detail::wholeRegion(r.get()), values.data(), values.size());
  detail::read(detail::wholeRegion(total.get()), &sum, 1);
  return {values, sum};
}

/// The index within 0 to n - 1 that an index up to n beyond the ends stands for; -1 for the border.
std::int64_t within(Boundary boundary, std::int64_t i, std::int64_t n) {
  if (i >= 0 && i < n) return i;
  switch (boundary) {
    case Boundary::Clamp: return i < 0 ? 0 : n - 1;
    case Boundary::Wrap: return (i + n) % n;
    case Boundary::Mirror: return i < 0 ? -1 - i : 2 * n - 1 - i;
    case Boundary::Border: break;
  }
  return -1;
}

/// As bodyOf; all sums are exact.
std::vector<float> weighedOnHost(Boundary boundary, int reach, const Shape& shape) {
  const std::vector<float> values = numbersOf(shape);
  const std::int64_t height = shape[0], width = shape[1];
  std::vector<float> result;
  const int step = reach > 2 ? reach / 2 : 1;
  for (std::int64_t row = 0; row < height; ++row) {
    for (std::int64_t column = 0; column < width; ++column) {
      float sum = 0, weight = 1;
      for (int y = -reach; y <= reach; y += step) {
        for (int x = -reach; x <= reach; x += step) {
          const std::int64_t i = within(boundary, row + y, height), k = within(boundary, column + x, width);
          sum += weight++ * (i < 0 || k < 0 ? -7 : values[static_cast<std::size_t>(i * width + k)]);
        }
      }
      result.push_back(sum);
    }
  }
  return result;
}

struct BoundaryAndReach {
  Boundary boundary;
  int reach;
};

}  // namespace

TEST_CASE("stencils that share texels in work groups") {
  const DeviceChoices choices{.target = Target::Compute, .traits = {.sharesTexels = true}};
  GlDevice device(gl::openContext({"software", gl::Api::Gl}), choices);
  // Where an index beyond the ends leads does not depend on the reach: each boundary has a reach, and each reach a boundary.
  std::deque<Weigh> kernels;
  for (const auto& [boundary, reach] : {BoundaryAndReach{Boundary::Clamp, 1},
                                        {Boundary::Wrap, 2},
                                        {Boundary::Mirror, 4},
                                        {Boundary::Border, 2}}) {
    const Kernel& kernel = kernels.emplace_back(boundary, reach).kernel;
    for (const Shape& shape : {Shape{5, 8}, Shape{16, 32}, Shape{17, 36}, Shape{33, 100}}) {
      CAPTURE(static_cast<int>(boundary), reach, shape[0], shape[1]);
      CHECK(weighed(device, kernel, shape) == weighedOnHost(boundary, reach, shape));
    }
  }
}

TEST_CASE("stencils that share texels in work groups of OpenGL ES") {
  const DeviceChoices choices{.target = Target::Compute, .traits = {.sharesTexels = true}};
  GlDevice device(gl::openContext({"software", gl::Api::Es}), choices);
  const Weigh weigh(Boundary::Mirror, 2);
  for (const Shape& shape : {Shape{5, 8}, Shape{33, 100}})
    CHECK(weighed(device, weigh.kernel, shape) == weighedOnHost(Boundary::Mirror, 2, shape));
}

TEST_CASE("stencils over parts of a whole that share texels in work groups") {
  const DeviceChoices choices{.target = Target::Compute, .traits = {.sharesTexels = true}};
  GlDevice device(gl::openContext({"software", gl::Api::Gl}), choices);
  std::deque<Weigh> kernels;
  for (const auto& [boundary, reach] : {BoundaryAndReach{Boundary::Clamp, 2},
                                        {Boundary::Wrap, 1},
                                        {Boundary::Mirror, 1},
                                        {Boundary::Border, 2}}) {
    const Kernel& kernel = kernels.emplace_back(boundary, reach).kernel;
    const Shape whole{61, 36};
    const std::vector<float> expected = weighedOnHost(boundary, reach, whole);
    for (const auto& [begin, end] : {std::pair{0, 17}, {17, 40}, {40, 61}}) {
      CAPTURE(static_cast<int>(boundary), reach, begin, end);
      const std::vector<float> rows(expected.begin() + begin * 36, expected.begin() + end * 36);
      CHECK(weighedInPart(device, kernel, whole, begin, end, reach, boundary == Boundary::Wrap) == rows);
    }
  }
}

TEST_CASE("stencils that fold what they store") {
  std::deque<WeighAndFold> folds;
  for (const bool shares : {true, false}) {
    const DeviceChoices choices{.target = Target::Compute, .traits = {.sharesTexels = shares}};
    GlDevice device(gl::openContext({"software", gl::Api::Gl}), choices);
    const WeighAndFold& fold = folds.emplace_back(Boundary::Wrap, 1);
    // packed, and in a column of groups; not packed; several tiles for each group
    for (const Shape& shape : {Shape{35, 36}, Shape{5, 7}, Shape{1, 4}, Shape{16 * 2100, 4}}) {
      CAPTURE(shares, shape[0], shape[1]);
      const std::vector<float> expected = weighedOnHost(Boundary::Wrap, 1, shape);
      float sum = 0;
      for (const float value : expected) sum += std::fmod(value, 16.0f);
      for (int round = 0; round < 2; ++round) {  // the groups that have finished are counted from 0 again
        const auto [values, total] = folded(device, fold.reduction, shape);
        CHECK(values == expected);
        CHECK(total == sum);
      }
    }
  }
}

}  // namespace sk
