// SPDX-License-Identifier: MIT
#include "call/placed.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "assemble/append/append_passes.hpp"
#include "assemble/condition.hpp"
#include "call/box.hpp"
#include "call/check_call.hpp"
#include "call/halo_limits.hpp"
#include "call/iterator.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/write_scope.hpp"

namespace sk {

using program::Boundary;
using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

IndexRange heldIn(const StreamRegion& region, int d) {
  const std::int64_t origin = originOf(region, d);
  return {origin, origin + region.shape[d]};
}

/// The letter of a dimension, x for the last one.
char letterOf(int rank, int d) { return "xyzw"[rank - 1 - d]; }

/// Whether `held` has the elements that a boundary mode gives for the indices in `read`, in a dimension of extent n.
bool holdsWhatIsRead(Boundary boundary, const IndexRange& held, const IndexRange& read, std::int64_t n) {
  if (boundary != Boundary::Wrap) return held.holds(broughtInside(boundary, read, n));
  const std::int64_t length = held.end - held.begin;
  if (length >= n) return true;
  const std::int64_t first = ((read.begin - held.begin) % n + n) % n;
  return first + read.end - read.begin <= length;
}

/// Whether any index at all may be read in dimension d.
bool holdsAll(Boundary boundary, const StreamRegion& region, int d) {
  const std::int64_t n = seenShape(region)[d];
  const IndexRange held = heldIn(region, d);
  return boundary == Boundary::Wrap ? held.end - held.begin >= n : held.holds({0, n});
}

void checkGather(const ResolvedCall& call, std::size_t gather, const Box& box) {
  const Parameter& parameter = call.kernel.parameters[gather];
  const StreamRegion& region = call.arguments[gather].region;
  const int rank = region.shape.rank();
  for (int d = 0; d < rank; ++d) {
    if (holdsAll(parameter.boundary, region, d)) continue;
    const IndexRange held = heldIn(region, d);
    const std::optional<HaloLimits> limits =
        haloLimits(call.kernel, call.arguments, gather, d, call.specs, call.domain);
    if (!limits) {
      fail(Error::Kind::Shape, call.kernel,
           "how far '{}' is read along {} is not known, and it holds only indices {} to {} (exclusive) of "
           "{}; promise "
           "a distance with [[halo(n)]] in a dimension that the domain has, too, or give a stream that "
           "holds all of them",
           parameter.name, letterOf(rank, d), held.begin, held.end, seenShape(region)[d]);
    }
    const GatherDimension dimension = gatherDimension(seenShape(region), d, call.domain);
    const IndexRange read = readBy(box, *limits, dimension);
    if (!holdsWhatIsRead(parameter.boundary, held, read, dimension.extent)) {
      fail(Error::Kind::Shape, call.kernel,
           "'{}' is read from {} before to {} after {} of the box {}, so from index {} to {} "
           "(exclusive) "
           "along {}, but it holds {} to {} of {}; give it a deeper halo, or a smaller box",
           parameter.name, limits->below, limits->above,
           limits->isPromised && dimension.extent != dimension.domainExtent
               ? "the relative places of the elements"
               : "the elements",
           toString(box), read.begin, read.end, letterOf(rank, d), held.begin, held.end, dimension.extent);
    }
  }
}

/// Whether a region has elements for the indices of `frame`, and, if it `mayRepeat`, extent 1 where the domain has more.
bool isInFrame(const StreamRegion& region, const StreamRegion& frame, bool mayRepeat) {
  const Shape &seen = seenShape(region), &domain = seenShape(frame);
  if (region.shape.rank() != frame.shape.rank()) return false;
  for (int d = 0; d < seen.rank(); ++d) {
    const bool isSame = seen[d] == domain[d] && originOf(region, d) == originOf(frame, d) &&
                        region.shape[d] == frame.shape[d];
    const bool repeats = mayRepeat && seen[d] == 1 && domain[d] != 1 && region.shape[d] == 1;
    if (!isSame && !repeats) return false;
  }
  return true;
}

/// How far a gather is read along dimension d, if that is known. Of variants of a kernel, only the greatest distance of a
/// neighbor is.
std::optional<HaloLimits> limitsOf(const ResolvedCall& call, std::size_t gather, int d) {
  const Parameter& parameter = call.kernel.parameters[gather];
  const StreamRegion& region = call.arguments[gather].region;
  if (parameter.halo.empty()) {
    const bool isNear = parameter.reach >= 0 && !parameter.usesAt && !parameter.usesSample;
    if (!isNear || seenShape(region) != call.domain) return std::nullopt;
    return HaloLimits{parameter.reach, parameter.reach};
  }
  return haloLimits(call.kernel, call.arguments, gather, d, call.specs, call.domain);
}

/// Whether boundary modes at the ends of what a gather holds give what those at the ends of the whole give, for elements
/// of the box.
bool hasSameBorders(const ResolvedCall& call, std::size_t gather, const Box& box) {
  const Parameter& parameter = call.kernel.parameters[gather];
  const StreamRegion& region = call.arguments[gather].region;
  for (int d = 0; d < region.shape.rank(); ++d) {
    const IndexRange held = heldIn(region, d);
    const std::int64_t n = seenShape(region)[d], length = held.end - held.begin;
    if (held.begin == 0 && length == n) continue;
    const std::optional<HaloLimits> limits = limitsOf(call, gather, d);
    if (!limits || limits->below > length || limits->above > length) return false;
    const bool wraps = parameter.boundary == Boundary::Wrap;
    const std::int64_t first = wraps ? held.begin : std::max<std::int64_t>(held.begin, 0);
    const std::int64_t end = wraps ? held.end : std::min(held.end, n);
    const bool isInside = box.begin[d] - limits->below >= first && box.end[d] + limits->above <= end;
    const bool endsLow = !wraps && held.begin == 0, endsHigh = !wraps && held.end == n;
    if (isInside) continue;
    if (box.begin[d] - limits->below < first && !endsLow) return false;
    if (box.end[d] + limits->above > end && !endsHigh) return false;
  }
  return true;
}

}  // namespace

bool hasPlaced(std::span<const Argument> arguments) {
  return std::ranges::any_of(arguments, [](const Argument& argument) { return isPlaced(argument.region); });
}

Box boxOrAll(const Box& box, const Shape& domain) {
  if (!box.isWhole()) return box;
  Box all{Index::origin(domain.rank()), Index::origin(domain.rank())};
  for (int d = 0; d < domain.rank(); ++d) all.end[d] = domain[d];
  return all;
}

Box heldBox(const StreamRegion& region) {
  const int rank = region.shape.rank();
  Box held{Index::origin(rank), Index::origin(rank)};
  for (int d = 0; d < rank; ++d) {
    held.begin[d] = originOf(region, d);
    held.end[d] = held.begin[d] + region.shape[d];
  }
  return held;
}

StreamRegion partOfWhole(const Kernel& kernel, const Parameter& parameter, const StreamRegion& region,
                         const Box& box) {
  const Box held = heldBox(region);
  Box local = box;
  for (int d = 0; d < region.shape.rank(); ++d) {
    if (box.begin[d] < held.begin[d] || box.end[d] > held.end[d]) {
      fail(Error::Kind::Shape, kernel,
           "'{}' holds the elements {} of a whole of shape {}, but the call needs {}; give a box of what it "
           "holds: "
           ".with({{.box = ...}})",
           parameter.name, toString(held), toString(seenShape(region)), toString(box));
    }
    local.begin[d] -= held.begin[d];
    local.end[d] -= held.begin[d];
  }
  return detail::partOf(region, local.begin, local.end);
}

void checkPlacedCall(const ResolvedCall& call, const Box& box, std::int64_t mostCounted) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = call.kernel.parameters[i];
    const StreamRegion& region = call.arguments[i].region;
    if (assemble::isAppendOutput(parameter)) {
      fail(call.kernel,
           "it pushes or scatters to '{}', which a call with placed streams cannot do; give streams that are "
           "whole",
           parameter.name);
    }
    if (parameter.role == Role::Iterator && countsElements(parameter, call.domain.rank()) &&
        call.domain.size() > mostCounted) {
      fail(
          Error::Kind::Shape, call.kernel,
          "the iterator '{}' advances with the element number, and the whole of shape {} has {} elements, of "
          "which this device counts {}; give it a component for each dimension",
          parameter.name, toString(call.domain), call.domain.size(), mostCounted);
    }
    const bool isElement = parameter.role == Role::Input || parameter.role == Role::Output;
    if (isElement && isPlaced(region) && assemble::isNeeded(parameter, call.specs))
      partOfWhole(call.kernel, parameter, region, boxIn(seenShape(region), call.domain, box));
  }
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = call.kernel.parameters[i];
    if (parameter.role == Role::Gather && isPlaced(call.arguments[i].region) &&
        assemble::isNeeded(parameter, call.specs))
      checkGather(call, i, box);
  }
}

namespace {

Box within(const StreamRegion& frame, const Box& box) {
  Box local = box;
  for (int d = 0; d < box.begin.rank(); ++d) {
    local.begin[d] -= originOf(frame, d);
    local.end[d] -= originOf(frame, d);
  }
  return local;
}

/// The first element output, which exists.
const StreamRegion& frameOf(const ResolvedCall& call) {
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = call.kernel.parameters[i];
    if (parameter.role == Role::Output && assemble::isNeeded(parameter, call.specs))
      return call.arguments[i].region;
  }
  return call.arguments[0].region;
}

bool isElement(const ResolvedCall& call, std::size_t i) {
  const Parameter& parameter = call.kernel.parameters[i];
  return (parameter.role == Role::Input || parameter.role == Role::Output) &&
         call.arguments[i].region.stream != nullptr && assemble::isNeeded(parameter, call.specs);
}

}  // namespace

std::optional<LocalCall> localCall(const ResolvedCall& call, const Box& box) {
  const Kernel& kernel = call.kernel;
  if (kernel.usesIndex || kernel.usesExtent) return std::nullopt;
  const StreamRegion& frame = frameOf(call);
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const StreamRegion& region = call.arguments[i].region;
    if (parameter.role == Role::Iterator) return std::nullopt;
    if (region.stream == nullptr || !assemble::isNeeded(parameter, call.specs)) continue;
    if (parameter.role == Role::Gather) {
      if (!isPlaced(region)) {
        if (parameter.usesNear) return std::nullopt;
        continue;
      }
      if (parameter.usesAt || parameter.usesSample || parameter.usesExtent ||
          !isInFrame(region, frame, false) || !hasSameBorders(call, i, box))
        return std::nullopt;
    } else if (parameter.role == Role::Input || parameter.role == Role::Output) {
      if (parameter.usesIndex || parameter.usesExtent ||
          !isInFrame(region, frame, parameter.role == Role::Input))
        return std::nullopt;
    }
  }
  LocalCall local{{call.arguments.begin(), call.arguments.end()}, frame.shape, within(frame, box)};
  for (Argument& argument : local.arguments) argument.region.placement = {};
  if (isAll(local.box, local.domain)) local.box = {};
  return local;
}

bool isReadAsHeld(const ResolvedCall& call, std::size_t gather, const Box& box) {
  const Parameter& parameter = call.kernel.parameters[gather];
  return parameter.usesNear && parameter.reach >= 0 && !parameter.usesAt && !parameter.usesSample &&
         call.arguments[gather].region.shape.rank() == call.domain.rank() &&
         hasSameBorders(call, gather, box);
}

LocalCall partCall(const ResolvedCall& call, const Box& box) {
  const StreamRegion& frame = frameOf(call);
  LocalCall part{{call.arguments.begin(), call.arguments.end()}, frame.shape, within(frame, box)};
  part.place = {heldBox(frame).begin, call.domain};
  bool areTogether = true;
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const bool mayRepeat = call.kernel.parameters[i].role == Role::Input;
    areTogether =
        areTogether && (!isElement(call, i) || isInFrame(call.arguments[i].region, frame, mayRepeat));
  }
  if (areTogether) {
    if (isAll(part.box, part.domain)) part.box = {};
    return part;
  }
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    if (!isElement(call, i)) continue;
    StreamRegion& region = part.arguments[i].region;
    const Shape seen = seenShape(region);
    const Box own = boxIn(seen, call.domain, box);
    region = partOfWhole(call.kernel, call.kernel.parameters[i], region, own);
    region.placement = {own.begin, seen};
  }
  part.domain =
      frameOf({call.kernel, part.arguments, call.options, call.specs, call.domain, call.plan}).shape;
  part.box = {};
  part.place.origin = box.begin;
  return part;
}

namespace {

std::unique_ptr<StreamState> streamLike(const StreamRegion& region) {
  const StreamState& stream = *region.stream;
  return stream.device->createStream(*stream.element, region.shape, stream.storage);
}

bool needsTemporary(const Kernel& kernel, std::span<const Argument> arguments, std::size_t i,
                    const assemble::SpecValues& specs) {
  const StreamRegion& region = arguments[i].region;
  // no value and no variable output has a stride
  return region.stream != nullptr && !isBox(region) && region.shape.size() > 0 &&
         assemble::isNeeded(kernel.parameters[i], specs) &&
         region.stream->device->needsDense(kernel, arguments, i);
}

bool hasStrides(std::span<const Argument> arguments) {
  for (const Argument& argument : arguments) {
    if (argument.region.stream != nullptr && !isBox(argument.region)) return true;
  }
  return false;
}

}  // namespace

DenseRegion::DenseRegion(const StreamRegion& region, bool isRead) : given_(region), region_(region) {
  if (isBox(region) || region.shape.size() == 0 || !region.stream->device->needsDense(region)) return;
  stream_ = streamLike(region);
  region_ = {stream_.get(), Index::origin(region.shape.rank()), region.shape};
  if (isRead) stream_->copyFrom(given_, region_);
}

void DenseRegion::finish() const {
  if (stream_) given_.stream->copyFrom(region_, given_);
}

DenseArguments::DenseArguments(const Kernel& kernel, std::span<const Argument> arguments)
    : given_(arguments) {
  if (!hasStrides(arguments)) return;
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (!needsTemporary(kernel, arguments, i, specs)) continue;
    const Role role = kernel.parameters[i].role;
    const bool isWritten = role == Role::Output || role == Role::Scatter || role == Role::Accumulator;
    replace(i, !isWritten || role == Role::Scatter, isWritten);
  }
}

void DenseArguments::replace(std::size_t i, bool isRead, bool isWritten) {
  if (arguments_.empty()) arguments_.assign(given_.begin(), given_.end());
  const StreamRegion& region = given_[i].region;
  Temporary& temporary = temporaries_.emplace_back(Temporary{i, streamLike(region), isWritten});
  StreamRegion& dense = arguments_[i].region;
  dense = {temporary.stream.get(), Index::origin(region.shape.rank()), region.shape};
  dense.placement = region.placement;
  if (isRead) temporary.stream->copyFrom(region, arguments_[i].region);
}

// Streams that got no elements before an error hold a mixture with those that did.
void DenseArguments::finish() const {
  WriteScope writes;
  for (const Temporary& one : temporaries_) {
    if (one.isWritten) writes.add(given_[one.argument].region.stream);
  }
  for (const Temporary& one : temporaries_) {
    if (!one.isWritten) continue;
    const StreamRegion& region = given_[one.argument].region;
    region.stream->copyFrom(arguments_[one.argument].region, region);
    writes.begin();
  }
  writes.commit();
}

bool needsDenseArguments(const Kernel& kernel, std::span<const Argument> arguments) {
  if (!hasStrides(arguments)) return false;
  const assemble::SpecValues specs = specsOf(kernel, arguments);
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (needsTemporary(kernel, arguments, i, specs)) return true;
  }
  return false;
}

}  // namespace sk
