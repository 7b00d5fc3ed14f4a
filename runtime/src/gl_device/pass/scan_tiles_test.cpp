// SPDX-License-Identifier: MIT
//
// Promises: scans by tiles, in one pass or several, have the same results as loops on the host, wherever a line ends in a
// tile, in any layout, and also if work groups never wait for each other. Runs on a software renderer, which by default
// scans item by item.
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include <catch2/catch.hpp>

#include "call/check_reduction.hpp"
#include "call/resolved_call.hpp"
#include "gl/open_context.hpp"
#include "gl_device/gl_device.hpp"
#include "sk/types.hpp"

namespace sk {
namespace {

using program::Element;
using program::Parameter;
using program::Role;

/// A scan of two streams with two accumulators of the same type, which folds elements as it combines. It must outlive the
/// devices, which identify it by its address.
struct PairScan {
  /// What the kernel does, on the bits of the elements.
  using Fold = void (*)(std::uint32_t x, std::uint32_t y, std::uint32_t& s, std::uint32_t& m);

  PairScan(const Element& element, const char* first, const char* second, const char* text,
           std::array<std::uint32_t, 2> identities, Fold onHost)
      : identityWords(identities),
        fold(onHost),
        parameters{
            {{.name = "x", .symbol = "x", .role = Role::Input, .element = &element},
             {.name = "y", .symbol = "y", .role = Role::Input, .element = &element},
             {.name = "s", .symbol = "s", .role = Role::Accumulator, .element = &element, .identity = first},
             {.name = "m",
              .symbol = "m",
              .role = Role::Accumulator,
              .element = &element,
              .identity = second}}} {
    reduction.fold = {.name = "pairs",
                      .entry = "pairs",
                      .declarations = {},
                      .body = text,
                      .parameters = parameters,
                      .sources = {}};
    reduction.combine = reduction.fold;
    reduction.combineOperands = operands;
    reduction.seeded = true;
  }

  std::array<std::uint32_t, 2> identityWords;
  Fold fold;
  std::array<Parameter, 4> parameters;
  std::array<std::uint8_t, 4> operands{0, 1, 2, 3};
  program::Reduction reduction{};
};

/// Maps r -> s * r + m, whose composition depends on the order; and sums and maxima of integers in floats, which take several passes.
const PairScan maps(ElementTraits<std::uint32_t>::element(), "1u", "0u",
                    "void pairs(uint x, uint y, inout uint s, inout uint m) { s *= x; m = m * x + y; }\n",
                    {1, 0}, [](std::uint32_t x, std::uint32_t y, std::uint32_t& s, std::uint32_t& m) {
                      s *= x;
                      m = m * x + y;
                    });
const PairScan floatPairs(
    ElementTraits<float>::element(), "0.0", "-1e30",
    "void pairs(float x, float y, inout float s, inout float m) { s += x; m = max(m, y); }\n",
    {0, std::bit_cast<std::uint32_t>(-1e30f)},
    [](std::uint32_t x, std::uint32_t y, std::uint32_t& s, std::uint32_t& m) {
      s = std::bit_cast<std::uint32_t>(std::bit_cast<float>(s) + std::bit_cast<float>(x));
      if (std::bit_cast<float>(y) > std::bit_cast<float>(m)) m = y;
    });

struct Problem {
  Shape shape;
  int along = -1;  ///< -1: the whole stream
  bool isExclusive = false;
  bool isView = false;  ///< without the first row and the last four columns
};

using Words = std::vector<std::uint32_t>;

Words numbers(const Element& element, std::int64_t count, unsigned seed) {
  std::mt19937 random(seed);
  Words words;
  for (std::int64_t i = 0; i < count; ++i) {
    const auto number = static_cast<std::int32_t>(random() % 64) - 32;
    const bool isFloat = element.fields[0].scalar == program::Scalar::Float;
    words.push_back(isFloat ? std::bit_cast<std::uint32_t>(static_cast<float>(number))
                            : static_cast<std::uint32_t>(number));
  }
  return words;
}

/// Both results, each in place of the other's input.
std::array<Words, 2> scanned(GlDevice& device, const PairScan& scan, const Problem& problem) {
  const Element& element = *scan.parameters[0].element;
  std::array<std::unique_ptr<StreamState>, 2> streams;
  std::array<Argument, 2> arguments;
  std::array<Words, 2> words;
  for (unsigned k = 0; k < 2; ++k) {
    words[k] = numbers(element, problem.shape.size(), k + 1);
    streams[k] = device.createStream(element, problem.shape, Storage::Single);
    arguments[k].region = detail::wholeRegion(streams[k].get());
    detail::write(arguments[k].region, words[k].data(), words[k].size());
    if (problem.isView) {
      arguments[k].region = {streams[k].get(), {1, 0}, {problem.shape[0] - 1, problem.shape[1] - 4}};
    }
  }
  ScanOrder order;
  if (problem.along >= 0) order.along = problem.along;
  order.isExclusive = problem.isExclusive;
  const std::array all{arguments[0], arguments[1], arguments[1], arguments[0]};
  device.reduce(checkReduction(scan.reduction, all, {}, order));
  for (unsigned k = 0; k < 2; ++k)
    detail::read(detail::wholeRegion(streams[k].get()), words[k].data(), words[k].size());
  return words;
}

/// The same on the host. Sums of the numbers are exact.
std::array<Words, 2> scannedOnHost(const PairScan& scan, const Problem& problem) {
  const Element& element = *scan.parameters[0].element;
  const std::int64_t count = problem.shape.size();
  std::array<Words, 2> words = {numbers(element, count, 1), numbers(element, count, 2)};
  const std::int64_t width = problem.shape[problem.shape.rank() - 1];
  std::array<std::uint32_t, 2> folded = scan.identityWords;
  for (std::int64_t i = 0; i < count; ++i) {
    if (problem.isView && (i < width || i % width >= width - 4)) continue;
    if (problem.along >= 0 && i % width == 0) folded = scan.identityWords;
    const auto at = static_cast<std::size_t>(i);
    const std::array<std::uint32_t, 2> before = folded;
    scan.fold(words[0][at], words[1][at], folded[0], folded[1]);
    const std::array<std::uint32_t, 2>& result = problem.isExclusive ? before : folded;
    words[1][at] = result[0];
    words[0][at] = result[1];
  }
  return words;
}

std::unique_ptr<GlDevice> open(const DeviceChoices& choices, gl::Api api = gl::Api::Gl) {
  return std::make_unique<GlDevice>(gl::openContext({"software", api}), choices);
}

TEST_CASE("tiles have the same results as loops") {
  const auto tiles = open({.target = Target::Compute, .traits = {.tilesScans = true, .chainsScans = false}});
  const auto chained = open({.target = Target::Compute, .traits = {.tilesScans = true, .chainsScans = true}});
  const auto hasty = open(
      {.target = Target::Compute, .traits = {.tilesScans = true, .chainsScans = true}, .scanPatience = -1});
  const Problem problems[] = {{{5}},
                              {{4097}, -1, true},
                              {{70001}},
                              {{98304}, -1, true},
                              {{3, 5000}, 1},
                              {{40, 1024}, 1, true},
                              {{40, 1024}},
                              {{40, 1028}, -1, false, true},
                              {{7, 1030}, 1, false, true}};
  for (const Problem& problem : problems) {
    CAPTURE(problem.shape.size(), problem.along, problem.isExclusive, problem.isView);
    const auto expected = scannedOnHost(maps, problem);
    CHECK((scanned(*tiles, maps, problem) == expected));
    if (problem.along >= 0) continue;  // lines are not chained
    CHECK((scanned(*chained, maps, problem) == expected));
    if (problem.shape.rank() == 1) CHECK((scanned(*hasty, maps, problem) == expected));
  }
  // What a tile folds does not depend on the layout: one inclusive and one exclusive scan, of a stream and of lines.
  for (const Problem& problem : {Problem{{70001}}, Problem{{40, 1024}, 1, true}})
    CHECK((scanned(*tiles, floatPairs, problem) == scannedOnHost(floatPairs, problem)));
}

/// Sums of one stream, whose items stay in the shared memory of a tile. It must outlive the devices.
struct OneSum {
  OneSum() {
    reduction.fold = {.name = "sum",
                      .entry = "sum",
                      .declarations = {},
                      .body = "void sum(uint x, inout uint s) { s += x; }\n",
                      .parameters = parameters,
                      .sources = {}};
    reduction.combine = reduction.fold;
    reduction.combineOperands = operands;
    reduction.seeded = true;
  }

  const Element& element = ElementTraits<std::uint32_t>::element();
  std::array<Parameter, 2> parameters{
      {{.name = "x", .symbol = "x", .role = Role::Input, .element = &element},
       {.name = "s", .symbol = "s", .role = Role::Accumulator, .element = &element, .identity = "0u"}}};
  std::array<std::uint8_t, 2> operands{0, 1};
  program::Reduction reduction{};
};
const OneSum oneSum;

TEST_CASE("tiles that are folded by others than their groups keep their own items") {
  for (const int patience : {-1, 1024}) {
    const auto device = open({.target = Target::Compute,
                              .traits = {.tilesScans = true, .chainsScans = true},
                              .scanPatience = patience});
    for (const std::int64_t count : {4097, 70001, 98304}) {
      for (const bool isExclusive : {false, true}) {
        CAPTURE(patience, count, isExclusive);
        Words words = numbers(oneSum.element, count, 1), expected = words;
        const auto from = device->createStream(oneSum.element, {count}, Storage::Single);
        const auto to = device->createStream(oneSum.element, {count}, Storage::Single);
        detail::write(detail::wholeRegion(from.get()), words.data(), words.size());
        ScanOrder order;
        order.isExclusive = isExclusive;
        const std::array<Argument, 2> arguments{
            {{.region = detail::wholeRegion(from.get())}, {.region = detail::wholeRegion(to.get())}}};
        device->reduce(checkReduction(oneSum.reduction, arguments, {}, order));
        detail::read(detail::wholeRegion(to.get()), words.data(), words.size());
        std::uint32_t sum = 0;
        for (std::uint32_t& word : expected) {
          const std::uint32_t item = word;
          word = isExclusive ? sum : sum + item;
          sum += item;
        }
        CHECK((words == expected));
      }
    }
  }
}

TEST_CASE("a scan of integers takes one pass") {
  for (const gl::Api api : {gl::Api::Gl, gl::Api::Es}) {
    const auto chained =
        open({.target = Target::Compute, .traits = {.tilesScans = true, .chainsScans = true}}, api);
    chained->passCount.emplace();
    const Problem problem{{98304}};
    CHECK((scanned(*chained, maps, problem) == scannedOnHost(maps, problem)));
    CHECK(chained->passCount->passes == 1);
  }
}

// A program of OpenGL ES may have four images and buffers together.
TEST_CASE("a scan takes more passes where its buffer would be one too many") {
  gl::OpenedContext opened = gl::openContext({"software", gl::Api::Es});
  opened.capabilities.images = opened.capabilities.outputResources = 3;
  GlDevice device(std::move(opened),
                  {.target = Target::Compute, .traits = {.tilesScans = true, .chainsScans = true}});
  device.passCount.emplace();
  const Problem problem{{70001}, -1, true};
  CHECK((scanned(device, maps, problem) == scannedOnHost(maps, problem)));
  CHECK(device.passCount->passes > 1);
}

}  // namespace
}  // namespace sk
