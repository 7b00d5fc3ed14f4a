// SPDX-License-Identifier: MIT
//
// Promises: scans by tiles, in one pass or several, have the same results as scans item by item, wherever a line ends in a
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
#include "call/resolved_reduction.hpp"
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
  PairScan(const Element& element, const char* first, const char* second, const char* text)
      : parameters{
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

  std::array<Parameter, 4> parameters;
  std::array<std::uint8_t, 4> operands{0, 1, 2, 3};
  program::Reduction reduction{};
};

/// Sums and maxima; maps r -> s * r + m, whose composition depends on the order; and sums and maxima of integers in floats,
/// which take several passes.
const PairScan sumAndMost(ElementTraits<std::int32_t>::element(), "0", "-2147483647 - 1",
                          "void pairs(int x, int y, inout int s, inout int m) { s += x; m = max(m, y); }\n");
const PairScan maps(ElementTraits<std::uint32_t>::element(), "1u", "0u",
                    "void pairs(uint x, uint y, inout uint s, inout uint m) { s *= x; m = m * x + y; }\n");
const PairScan floats(
    ElementTraits<float>::element(), "0.0", "-1e30",
    "void pairs(float x, float y, inout float s, inout float m) { s += x; m = max(m, y); }\n");

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

std::unique_ptr<GlDevice> open(const DeviceChoices& choices) {
  return std::make_unique<GlDevice>(gl::openContext({"software", gl::Api::Gl}), choices);
}

TEST_CASE("tiles have the same results as items") {
  const auto items = open({.target = Target::Compute});
  const auto tiles = open({.target = Target::Compute, .tilesScans = true, .chainsScans = false});
  const auto chained = open({.target = Target::Compute, .tilesScans = true, .chainsScans = true});
  const auto hasty =
      open({.target = Target::Compute, .tilesScans = true, .chainsScans = true, .scanPatience = -1});
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
    for (const PairScan* scan : {&sumAndMost, &maps, &floats}) {
      const auto expected = scanned(*items, *scan, problem);
      CHECK((scanned(*tiles, *scan, problem) == expected));
      if (scan == &floats || problem.along >= 0) continue;  // these are not chained
      CHECK((scanned(*chained, *scan, problem) == expected));
      CHECK((scanned(*hasty, *scan, problem) == expected));
    }
  }
}

TEST_CASE("a scan of integers takes one pass") {
  const auto chained = open({.target = Target::Compute, .tilesScans = true, .chainsScans = true});
  chained->passCount.emplace();
  scanned(*chained, sumAndMost, {{98304}});
  CHECK(chained->passCount->passes == 1);
}

}  // namespace
}  // namespace sk
