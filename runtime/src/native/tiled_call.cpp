// SPDX-License-Identifier: MIT
#include "native/tiled_call.hpp"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "call/halo_limits.hpp"

namespace sk {

using native::Extents;
using program::Boundary;
using program::Parameter;
using program::Role;

namespace {

/// The index of a box's first element in its stream, fastest dimension first.
Extents originIn(const StreamRegion& region) {
  Extents origin{};
  const int rank = region.begin.rank();
  for (int d = 0; d < rank; ++d) origin[static_cast<std::size_t>(rank - 1 - d)] = region.begin[d];
  return origin;
}

}  // namespace

TiledCall::TiledCall(const PreparedRun& run)
    : run_(run),
      operands_(run.choice().real, run.kernel(), run.resolved().arguments, run.resolved().domain,
                run.tables(), false, run.resolved().options.box),
      call_(operands_.callAsItIs()) {
  call_.isSilent = run.device().isSilent;
  if (!operands_.mayRunAgain()) {
    whyNot_ = "it converts the elements of a stream";
    return;
  }
  findUses();
}

void TiledCall::findUses() {
  const program::Kernel& kernel = run_.kernel();
  const std::span<const Argument> arguments = run_.resolved().arguments;
  if (kernel.code->isUneven != 0) {
    whyNot_ = "its elements take different times, or print";
    return;
  }
  const StreamRegion* output = nullptr;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& parameter = kernel.parameters[i];
    const StreamRegion& region = arguments[i].region;
    if (parameter.role == Role::Scatter || parameter.role == Role::VariableOutput) {
      whyNot_ = fmt::format("'{}' gets elements in any order", parameter.name);
    } else if (region.stream != nullptr && isPlaced(region)) {
      whyNot_ = fmt::format("'{}' is a part of a whole", parameter.name);
    } else if (parameter.role == Role::Output && region.stream != nullptr) {
      const NativeStream& stream = nativeStream(region);
      if (!isBox(region)) whyNot_ = fmt::format("'{}' is a view with strides", parameter.name);
      if (stream.storage == Storage::Half && stream.components.real() == RealType::Float)
        whyNot_ = fmt::format("'{}' is stored in halves", parameter.name);
      if (output == nullptr) output = &region;
    }
    if (parameter.role == Role::Gather && parameter.boundary == Boundary::Border &&
        operands_.readsValuesInStreams())
      whyNot_ = fmt::format("the border of '{}' may depend on a value in a stream", parameter.name);
    if (!whyNot_.empty()) return;
  }
  if (output == nullptr || output->shape.size() == 0) {
    whyNot_ = "it writes no elements";
    return;
  }
  extent_ = fastestFirst(output->stream->shape);
  origin_ = originIn(*output);
  const Box& box = run_.resolved().options.box;
  computed_ = {.first = origin_, .extent = fastestFirst(run_.resolved().domain)};
  for (int d = 0; d < box.begin.rank(); ++d) {
    const auto axis = static_cast<std::size_t>(box.begin.rank() - 1 - d);
    computed_.first[axis] = origin_[axis] + box.begin[d];
    computed_.extent[axis] = box.end[d] - box.begin[d];
  }
  for (const Operands::Lent& lent : operands_.lent()) addUse(lent);
  operands_.forEachValueInStream([&](NativeStream& stream) { values_.push_back(&stream); });
}

void TiledCall::addUse(const Operands::Lent& lent) {
  const Role role = run_.kernel().parameters[lent.operand].role;
  const bool isOutput = role == Role::Output;
  const bool wraps =
      role == Role::Gather && run_.kernel().parameters[lent.operand].boundary == Boundary::Wrap;
  uses_.push_back({lent.stream, lent.isSpare, isOutput, distanceOf(lent.operand), lent.operand, wraps});
  for (std::size_t d = 0; d < 4; ++d) isPeriodic_[d] = isPeriodic_[d] || (wraps && extent_[d] > 1);
}

/// Dimensions in which nothing is known, or which differ from those of the stream that is written, have any distance.
Extents TiledCall::distanceOf(std::size_t i) const {
  const program::Kernel& kernel = run_.kernel();
  const Parameter& parameter = kernel.parameters[i];
  const Argument& argument = run_.resolved().arguments[i];
  const StreamRegion& region = argument.region;
  const Shape& domain = run_.resolved().domain;
  Extents distance;
  distance.fill(native::anyDistance);
  if (!isBox(region) || fastestFirst(region.stream->shape) != extent_ || region.shape.rank() != domain.rank())
    return distance;
  const Extents origin = originIn(region);
  const Extents given = fastestFirst(region.shape), needed = fastestFirst(domain);
  for (std::size_t d = 0; d < 4; ++d) {
    std::int64_t reach = 0;
    if (parameter.role == Role::Gather) {
      const auto rank = static_cast<std::size_t>(domain.rank());
      if (d >= rank) {
        distance[d] = 0;
        continue;
      }
      const std::optional<HaloLimits> limits =
          haloLimits(kernel, run_.resolved().arguments, i, static_cast<int>(rank - 1 - d),
                     run_.resolved().specs, domain);
      // other boundary modes bring indices inside, no farther from the element than they were, if that is inside, too
      const bool isWithin =
          given[d] >= needed[d] && (parameter.boundary != Boundary::Wrap || given[d] == extent_[d]);
      // what is promised of another extent counts from a scaled index
      if (!limits || !isWithin || (limits->isPromised && given[d] != needed[d])) continue;
      reach = std::max(limits->below, limits->above);
    } else if (given[d] != needed[d]) {
      continue;
    }
    distance[d] = reach + std::abs(origin[d] - origin_[d]);
  }
  return distance;
}

const BoxCode& TiledCall::code() {
  withArrays();
  for (const std::unique_ptr<BoxCode>& code : codes_) {
    if (code->hasArraysOf(call_)) return *code;
  }
  codes_.push_back(std::make_unique<BoxCode>(run_.kernel(), call_, run_.choice()));
  return *codes_.back();
}

void TiledCall::run(const BoxCode& code, const native::Part& box) const {
  native::Part own;
  for (std::size_t d = 0; d < 4; ++d) {
    const std::int64_t begin = std::max(box.first[d], computed_.first[d]);
    const std::int64_t end = std::min(box.first[d] + box.extent[d], computed_.first[d] + computed_.extent[d]);
    if (begin >= end) return;
    own.first[d] = begin - origin_[d];
    own.extent[d] = end - begin;
  }
  code.run(own);
}

}  // namespace sk
