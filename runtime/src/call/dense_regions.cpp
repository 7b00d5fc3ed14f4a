// SPDX-License-Identifier: MIT
#include "call/dense_regions.hpp"

#include <utility>

#include "assemble/condition.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/write_scope.hpp"

namespace sk {

namespace {

using program::Kernel;
using program::Role;

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
