// SPDX-License-Identifier: MIT
#include "call/box.hpp"

#include <algorithm>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/check_argument.hpp"
#include "call/resolved_call.hpp"
#include "device/region.hpp"
#include "device/stream_state.hpp"

namespace sk {

using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

std::string toString(const Box& box) { return sk::toString(box.begin) + " to " + sk::toString(box.end); }

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
  if (argument.region.stream == nullptr || argument.region.shape.rank() != domain.rank()) return result;
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
  Box own = box;
  const Shape& shape = argument.region.shape;
  for (int d = 0; d < shape.rank(); ++d) {
    if (shape[d] != 1 || domain[d] == 1) continue;
    own.begin[d] = 0;  // broadcast
    own.end[d] = 1;
  }
  result.region = partIn(argument.region, own);
  return result;
}

}  // namespace

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
    if (arguments[i].region.stream->isBroken && !isAll(box, domain)) {
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

std::vector<Argument> argumentsIn(const Kernel& fold, std::span<const Argument> arguments, const Box& box) {
  if (arguments.size() != fold.parameters.size())
    return {arguments.begin(), arguments.end()};  // checked later
  const Shape domain = domainOf(fold, arguments, specsOf(fold, arguments));
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
  }
  return result;
}

}  // namespace sk
