// SPDX-License-Identifier: MIT
#include "call/box.hpp"

#include <algorithm>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/check_argument.hpp"
#include "call/placed.hpp"
#include "call/resolved_call.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"

namespace sk {

using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

/// What about a fold depends on the place of an element in the domain, or an empty text.
std::string_view askedPlace(const Kernel& fold) {
  if (fold.usesIndex) return "indexof";
  if (fold.usesExtent) return "extentof";
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.usesIndex) return "indexof";
    if (parameter.usesExtent && parameter.role != Role::Gather) return "extentof";
    if (parameter.usesNear) return "neighbor";
    if (parameter.role == Role::Iterator) return "an iterator";
  }
  return {};
}

Argument inBox(const Kernel& fold, const Parameter& input, const Argument& argument, const Box& box,
               const Shape& domain) {
  Argument result = argument;
  const Shape& shape = seenShape(argument.region);
  if (argument.region.stream == nullptr || shape.rank() != domain.rank()) return result;
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
  result.region = isPlaced(argument.region) ? partOfWhole(fold, input, argument.region, own)
                                            : partIn(argument.region, own);
  return result;
}

/// Elements of a fold count from the start of the box, so that no halo is theirs: a gather must hold its whole.
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
    if (arguments[i].region.stream->isBroken && !isOverwritten) {
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

std::vector<Argument> argumentsIn(const Kernel& fold, std::span<const Argument> arguments, const Box& given) {
  if (arguments.size() != fold.parameters.size())
    return {arguments.begin(), arguments.end()};  // checked later
  const Shape domain = domainOf(fold, arguments, specsOf(fold, arguments));
  const Box box = boxOrAll(given, domain);
  checkBox(fold, box, domain);
  if (const std::string_view asked = askedPlace(fold); !asked.empty()) {
    fail(fold,
         "it uses {}, which counts from the start of what a reduction folds; let a kernel with this box "
         "store what "
         "is to be folded, and fold that",
         asked);
  }
  std::vector<Argument> result(arguments.begin(), arguments.end());
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Parameter& parameter = fold.parameters[i];
    if (parameter.role == Role::Input || parameter.role == Role::Output)
      result[i] = inBox(fold, parameter, arguments[i], box, domain);
    if (parameter.role == Role::Gather) result[i] = wholeGather(fold, parameter, arguments[i]);
    if (isPlaced(result[i].region)) refusePlaced(fold, parameter);
  }
  return result;
}

}  // namespace sk
