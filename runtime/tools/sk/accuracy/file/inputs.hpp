// SPDX-License-Identifier: MIT
//
// Arguments for a kernel whose parameters are known at run time, drawn from a fixed seed: ordinary ones, or ones with
// extremes among them. Host memory alone: call.hpp brings them to a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "accuracy/file/ranges.hpp"
#include "sk/shape.hpp"

namespace sk_tool {

/// Where extremes are: numbers at which formats end, and those at the ends of ranges. Only reals have some: an integer
/// may count a loop.
enum class Extremes : std::uint8_t { None, InElements, InValues };

/// How much is drawn.
struct Extent {
  sk::Shape domain;
  sk::Shape results;  ///< of a kernel the domain; of a reduce, whose extents divide that
  int draws = 1;  ///< of the host values, each for a call of its own
};

struct ParameterInput {
  sk::Shape shape = {};  ///< of a stream
  std::vector<std::byte> bytes =
      {};  ///< the elements, row-major; of a host value one after the other for each draw
};

struct Inputs {
  Extent extent;
  std::vector<ParameterInput> parameters;  ///< of results just the shapes
  std::vector<std::int64_t> elements;  ///< of each result, the element in the domain by which it is told
};

Inputs drawInputs(const Subject& subject, const Ranges& ranges, const Extent& extent, Extremes extremes);

/// Dimensions that the domain should have, as the gathers and iterators want it.
int rankOf(const Subject& subject);
/// Of one to four extents.
sk::Shape shapeOf(std::span<const std::int64_t> extents);
/// A line, square, cube ... of `count` elements at least.
sk::Shape cubeOf(int rank, std::int64_t count);

/// Whether a draw changes anything: a uniform is neither set nor absent.
bool hasDrawnValues(const Subject& subject, const Ranges& ranges);
/// Reals in elements, or in host values, that may become extreme.
std::size_t extremeScalars(const Subject& subject, const Ranges& ranges, Extremes extremes);
/// Of one scalar, at most.
inline constexpr std::size_t mostExtremes = 21;

/// Where a result is, rows first: "3, 5".
std::string indexOf(const Inputs& inputs, std::size_t result);
/// The inputs of a result by name, as Json that jsonOf() makes of scalars; gathers by their element in that place.
Json inputsOf(const Subject& subject, const Inputs& inputs, int draw, std::size_t result);

}  // namespace sk_tool
