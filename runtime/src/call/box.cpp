// SPDX-License-Identifier: MIT
//
// Enumerates the block grids that are compatible with the result's shape.
#include "call/box.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/check_call.hpp"
#include "call/placed.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"
#include "domain/decomposition.hpp"

namespace sk {

using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

Argument inBox(const Kernel& fold, const Parameter& input, const Argument& argument, const Box& box,
               const Shape& domain) {
  Argument result = argument;
  const Shape& shape = seenShape(argument.region);
  if (shape.rank() != domain.rank()) return result;
  if (argument.rows != nullptr) {
    fail(fold,
         "'{}' is in rows of different lengths, of which there are no boxes; give rows of a part of them",
         input.name);
  }
  if (argument.fit != program::Fit::Same) {
    fail(fold,
         "'{}' is stretched or strided, which a box of the domain has no part of; copy it to a stream of the "
         "domain's shape",
         input.name);
  }
  const Box own = boxIn(shape, domain, box);
  if (argument.region.stream == nullptr) {  // an output that another call writes
    result.region.shape = domain::shapeOf(own);
  } else {
    result.region = isPlaced(argument.region) ? partOfWhole(fold, input, argument.region, own)
                                              : partIn(argument.region, own);
  }
  return result;
}

/// The most elements that the device of these arguments counts.
std::int64_t mostCounted(std::span<const Argument> arguments) {
  for (const Argument& argument : arguments) {
    const StreamState* const stream = argument.region.stream;
    if (stream != nullptr && stream->device != nullptr) return stream->device->limits.elements;
  }
  return std::numeric_limits<std::int64_t>::max();
}

/// The box of an input or output, placed in its whole.
Argument placedInBox(const Kernel& fold, const Parameter& parameter, const Argument& argument, const Box& box,
                     const Shape& domain) {
  Argument result = inBox(fold, parameter, argument, box, domain);
  const Shape& seen = seenShape(argument.region);
  if (seen.rank() == domain.rank()) result.region.placement = {boxIn(seen, domain, box).begin, seen};
  return result;
}

/// A fold that does not ask where its elements are has no halo: a gather must hold its whole.
Argument wholeGather(const Kernel& fold, const Parameter& gather, const Argument& argument) {
  Argument result = argument;
  if (isPlaced(argument.region))
    result.region = partOfWhole(fold, gather, argument.region, boxOrAll({}, seenShape(argument.region)));
  return result;
}

}  // namespace

std::string toString(const Box& box) { return sk::toString(box.begin) + " to " + sk::toString(box.end); }

Box boxIn(const Shape& input, const Shape& domain, const Box& box) {
  Box own = box;
  for (int d = 0; d < input.rank(); ++d) {
    if (input[d] != 1 || domain[d] == 1) continue;
    own.begin[d] = 0;
    own.end[d] = 1;
  }
  return own;
}

void checkBox(const Kernel& kernel, const Box& box, const Shape& domain) {
  if (box.begin.rank() != domain.rank() || box.end.rank() != domain.rank()) {
    fail(Error::Kind::Shape, kernel,
         "the box {} has {} and {} dimension(s), but the domain has shape {}; give both ends as many as the "
         "domain",
         toString(box), box.begin.rank(), box.end.rank(), sk::toString(domain));
  }
  for (int d = 0; d < domain.rank(); ++d) {
    if (box.begin[d] >= box.end[d]) {
      fail(Error::Kind::Shape, kernel,
           "the box {} is empty in dimension {}; the end is exclusive, and must be above the begin",
           toString(box), d);
    }
    if (box.begin[d] < 0 || box.end[d] > domain[d]) {
      fail(Error::Kind::Shape, kernel, "the box {} is not inside the domain, which has shape {}",
           toString(box), sk::toString(domain));
    }
  }
}

bool isAll(const Box& box, const Shape& domain) {
  for (int d = 0; d < domain.rank(); ++d) {
    if (box.begin[d] != 0 || box.end[d] != domain[d]) return false;
  }
  return true;
}

void checkBoxedCall(const Kernel& kernel, std::span<const Argument> arguments, const Box& box,
                    const Shape& domain) {
  checkBox(kernel, box, domain);
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    if (assemble::isAppendOutput(parameter)) {
      fail(kernel,
           "it pushes or scatters to '{}', which has no elements of its own in a box of the domain; call it "
           "without a box",
           parameter.name);
    }
    if (parameter.role != Role::Output || !assemble::isNeeded(parameter, specs)) continue;
    const bool isOverwritten = isAll(box, domain) && !isPlaced(arguments[i].region);
    if (arguments[i].region.stream->isLost() && !isOverwritten) {
      fail(Error::Kind::Lost, kernel,
           "the elements of '{}' are lost, since what wrote them has failed, and a box would restore only "
           "some; write "
           "all of the stream first",
           parameter.name);
    }
    if (!isBox(arguments[i].region)) {
      fail(kernel,
           "'{}' is a strided or reshaped view, of which no box can be written; give a stream, or a box of "
           "one",
           parameter.name);
    }
  }
}

StreamRegion partIn(const StreamRegion& region, const Box& box) {
  return box.isWhole() ? region : detail::partOf(region, box.begin, box.end);
}

bool asksPlace(const Kernel& fold) {
  return fold.usesIndex || fold.usesExtent ||
         std::ranges::any_of(fold.parameters, [](const Parameter& parameter) {
           return parameter.usesIndex || parameter.usesNear || parameter.role == Role::Iterator ||
                  (parameter.usesExtent && parameter.role != Role::Gather);
         });
}

BoxedArguments argumentsIn(const Kernel& fold, std::span<const Argument> arguments, const Box& given,
                           const std::optional<GivenDomain>& over) {
  BoxedArguments result{.arguments = {arguments.begin(), arguments.end()}, .over = over};
  if (arguments.size() != fold.parameters.size()) return result;  // checked later
  const assemble::SpecValues specs = specsOf(fold, arguments);
  const Shape domain = domainOf(fold, arguments, specs, over);
  checkDomain(fold, {firstOutput(fold, specs), over ? &*over : nullptr}, domain);
  const Box box = boxOrAll(given, domain);
  checkBox(fold, box, domain);
  const bool isPlaced = asksPlace(fold);
  if (isPlaced) {
    checkPlacedCall({fold, arguments, {}, specs, domain, nullptr}, box, mostCounted(arguments));
    result.placed = {box, domain};
  } else if (over) {
    result.over->shape = domain::shapeOf(box);
  }
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& parameter = fold.parameters[i];
    Argument& argument = result.arguments[i];
    if (parameter.role == Role::Input || parameter.role == Role::Output) {
      argument = isPlaced ? placedInBox(fold, parameter, arguments[i], box, domain)
                          : inBox(fold, parameter, arguments[i], box, domain);
    } else if (parameter.role == Role::Gather) {
      if (!isPlaced) argument = wholeGather(fold, parameter, arguments[i]);
    } else if (sk::isPlaced(argument.region)) {
      refusePlaced(fold, parameter);
    }
  }
  return result;
}

namespace {

Shape shapeOf(const std::array<std::int64_t, maxRank>& extents, int rank) {
  switch (rank) {
    case 1: return {extents[0]};
    case 2: return {extents[0], extents[1]};
    case 3: return {extents[0], extents[1], extents[2]};
    default: return {extents[0], extents[1], extents[2], extents[3]};
  }
}

bool divides(const Shape& grid, const Shape& domain) {
  for (int d = 0; d < domain.rank(); ++d) {
    if (grid[d] == 0 ? domain[d] != 0 : domain[d] % grid[d] != 0) {
      return false;
    }
  }
  return true;
}

}  // namespace

std::vector<Shape> blockGrids(const Shape& domain, const Shape& result) {
  std::vector<Shape> grids;
  const int rank = domain.rank();
  for (unsigned kept = 0; kept < 1u << rank; ++kept) {  // bit d: dimension d belongs to the result
    std::array<std::int64_t, maxRank> extents{1, 1, 1, 1};
    int next = 0;
    for (int d = 0; d < rank; ++d) {
      if ((kept >> d & 1u) != 0) {
        extents[static_cast<std::size_t>(d)] = next < result.rank() ? result[next] : 1;
        ++next;
      }
    }
    if (next != result.rank()) {
      continue;
    }
    const Shape grid = shapeOf(extents, rank);
    if (divides(grid, domain) && std::find(grids.begin(), grids.end(), grid) == grids.end()) {
      grids.push_back(grid);
    }
  }
  return grids;
}

Shape oneBlock(Shape domain) {
  for (int d = 0; d < domain.rank(); ++d) domain = domain.with(d, 1);
  return domain;
}

}  // namespace sk
