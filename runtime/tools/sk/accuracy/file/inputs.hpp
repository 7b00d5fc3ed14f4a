// SPDX-License-Identifier: MIT
//
// Draws arguments, from a fixed seed, for a kernel whose parameters are known only at run time: ordinary
// ones, or ones with extremes among them. Uses only host memory; call.hpp copies them to a device.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "accuracy/file/ranges.hpp"
#include "sk/shape.hpp"

namespace sk_tool {

/// The location of extremes: limits of formats, and the ends of ranges. Only reals are extreme: an integer
/// might be a trip count. AtExponents: ordinary elements, in which reals are powers of 2 and their neighbours.
enum class Extremes : std::uint8_t { None, InElements, InValues, AtExponents };

/// The number of inputs to draw.
struct Extent {
  sk::Shape domain;
  sk::Shape results;  ///< kernels: the domain; reductions: a shape whose extents divide the domain's
  int draws = 1;  ///< of the host values, each for a separate call
};

struct ParameterInput {
  sk::Shape shape = {};  ///< of a stream
  /// The elements, row-major; for a host value, one per draw.
  std::vector<std::byte> bytes = {};
  bool isAbsent = false;  ///< a stream that the spec parameters switch off
};

struct Inputs {
  Extent extent;
  std::vector<ParameterInput> parameters;  ///< for results, only shapes
  std::vector<std::int64_t> elements;  ///< for each result, the domain element that identifies it
};

/// For each result, the element that identifies it: one of its block, at a position that varies with the result.
std::vector<std::int64_t> identifyingElements(const Extent& extent);
/// Whether each result of an elementwise subject depends on the elements of its own index.
bool areAligned(const Subject& subject, const Inputs& inputs);

Inputs drawInputs(const Subject& subject, const Ranges& ranges, const Extent& extent, Extremes extremes);

/// Whether each result depends on one element alone, and on host values.
bool isElementwise(const Subject& subject);
/// The inputs of some elements, with the host values of one draw, for an elementwise subject.
Inputs inputsAt(const Subject& subject, const Inputs& inputs, int draw,
                std::span<const std::size_t> elements);
/// Elements near those of inputsAt(): from the ones next to them to some that differ in all but the first bits. The reals stay in
/// their ranges. Of `count` elements, the first are the given ones.
Inputs inputsNear(const Subject& subject, const Ranges& ranges, const Inputs& centres, std::int64_t count,
                  unsigned seed);
/// Elements evenly between the first of inputsAt() and the second, the third and the fourth ...
Inputs inputsBetween(const Subject& subject, const Inputs& ends, std::int64_t countOfEach);
/// The scalars of elements that are drawn and real, one for each scalar: its values in all elements.
std::vector<std::vector<double>> drawnReals(const Subject& subject, const Ranges& ranges,
                                            const Inputs& inputs);

/// The rank of the domain that the gathers and iterators require.
int rankOf(const Subject& subject);
/// Takes one to four extents.
sk::Shape shapeOf(std::span<const std::int64_t> extents);
/// A line, square, cube ... of at least `count` elements.
sk::Shape cubeOf(int rank, std::int64_t count);

/// Whether draws differ: there is a uniform that is neither set nor absent.
bool hasDrawnValues(const Subject& subject, const Ranges& ranges);
/// The number of reals, in elements or host values, that may become extreme.
std::size_t extremeScalars(const Subject& subject, const Ranges& ranges, Extremes extremes);
/// The most extremes of one scalar.
inline constexpr std::size_t mostExtremes = 21;

/// The index of a result as text, rows first: "3, 5".
std::string indexOf(const Inputs& inputs, std::size_t result);
/// The inputs of a result by name, in jsonOf()'s format for scalars; for gathers, the element at that index.
Json inputsOf(const Subject& subject, const Inputs& inputs, int draw, std::size_t result);

}  // namespace sk_tool
