// SPDX-License-Identifier: MIT
#include "gl_device/pass/kernel_operands.hpp"

#include "assemble/assemble.hpp"
#include "call/check_call.hpp"
#include "call/placed.hpp"
#include "device/region.hpp"
#include "gl_device/gl_stream.hpp"

namespace sk {

using assemble::RegionLayout;
using program::Parameter;
using program::Role;

DrawnRects::DrawnRects(const RegionLayout& domain, const Layout& layout) {
  if (!domain.linear) {
    const RegionLayout texels = domain.packed ? assemble::texelsOf(domain) : domain;
    plane_ = {texels.origin[0], texels.origin[1], texels.extent[0], texels.extent[1]};
    rects_ = {&plane_, 1};
  } else if (!domain.view) {
    rects_ = layout.draws;
  } else {
    list_ = assemble::drawnTexels(domain);
    rects_ = list_;
  }
}

KernelOperands::KernelOperands(GlDevice& device, const program::Kernel& kernel,
                               std::span<const Argument> arguments, const assemble::SpecValues& specs,
                               const program::Plan* plan, const Shape& shape, const Box& box,
                               const Placement& place)
    : device_(device),
      kernel_(kernel),
      arguments_(arguments),
      specs_(specs),
      plan_(plan),
      scratch_(device.passes().operands()),
      shape_(shape),
      box_(box),
      place_(place) {
  operands_.resize(arguments_.size());
  while (hasOutput() && !isOutput(first_)) {
    ++first_;
  }
  if (hasOutput()) {
    shape_ = arguments_[first_].region.shape;
    layOut();
  } else {
    layOutLikeStream();
  }
  if (isPlaced()) {
    domain_.placed = true;
    domain_.place = {xFirst(place_.origin), {}, xFirst(place_.whole)};
  }
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    operands_[i] = operandOf(i);
  }
}

/// Chooses the layout of the outputs: packed if possible. Streams that are written only in part keep their
/// layout, or are unpacked.
void KernelOperands::layOut() {
  const StreamRegion& region = arguments_[first_].region;
  GlStream& stream = glStream(region);
  const bool packs = mayWritePacked();
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (needsUnpacked(i) || (!packs && isWrittenInPlace(i))) glStream(arguments_[i].region).unpack();
  }
  layout_ = &stream.layout;
  if (stream.layout.whole.packed != packs) {
    newLayout_ = layoutOf(stream.shape, device_.textureLimits(), packs);
    layout_ = &newLayout_;
  }
  domain_ = regionLayoutOf(region, *layout_);
}

void KernelOperands::layOutLikeStream() {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (needsUnpacked(i)) glStream(arguments_[i].region).unpack();
  }
  newLayout_ =
      layoutOf(shape_, device_.textureLimits(), mayPack(shape_) && assemble::mayWritePacked(kernel_));
  layout_ = &newLayout_;
  domain_ = newLayout_.whole;
}

/// Whether an output's planes cannot be replaced, because only a part of a stream is written, or the domain is only a
/// part of one.
bool KernelOperands::isWrittenInPlace(std::size_t i) const {
  const auto isPart = [](const StreamRegion& region) { return region.shape != region.stream->shape; };
  return isOutput(i) &&
         (!box_.isWhole() || isPart(arguments_[i].region) || isPart(arguments_[first_].region));
}

/// Whether the outputs can be written packed.
bool KernelOperands::mayWritePacked() const {
  bool may = plan_ == nullptr && assemble::mayWritePacked(kernel_);
  for (std::size_t i = 0; may && i < arguments_.size(); ++i) {
    if (!isOutput(i)) continue;
    const StreamRegion& region = arguments_[i].region;
    const GlStream& stream = glStream(region);
    may = stream.canPack();
    if (may && isWrittenInPlace(i)) {
      may = stream.layout.whole.packed &&
            assemble::isWholeTexels(partOf(regionLayoutOf(region, stream.layout), region.shape.rank(), box_));
    }
  }
  return may;
}

/// Whether an argument must be unpacked before it is read: plans and linear filters do not support packed
/// texels.
bool KernelOperands::needsUnpacked(std::size_t i) const {
  const Role role = kernel_.parameters[i].role;
  const bool isRead = (role == Role::Input || role == Role::Gather) && isNeeded(i);
  return isRead && (plan_ != nullptr || assemble::mayFilter(kernel_.parameters[i]));
}

Operand KernelOperands::operandOf(std::size_t i) const {
  const Parameter& parameter = kernel_.parameters[i];
  const Argument& argument = arguments_[i];
  if (parameter.role == Role::Uniform) return uniformOperand(argument);
  if (parameter.role == Role::Spec) return {.value = argument.value};
  if (parameter.role == Role::Iterator) {
    return iteration(parameter, argument.value, isPlaced() ? place_.whole : shape_);
  }
  if (parameter.role == Role::Accumulator || !isNeeded(i)) return {};
  Operand operand = regionOperand(argument, shape_);
  assemble::RegionLayout& layout = operand.regionLayout;
  if (parameter.role == Role::Gather && sk::isPlaced(argument.region)) {
    layout = placedLayout(i, layout);
  } else if (parameter.role == Role::Input && isPlaced()) {
    layout.placed = true;
    layout.place.whole = xFirst(seenShape(argument.region));
  }
  return operand;
}

/// The layout of a placed gather: local if that reads the same, and texels hold the same elements as the domain's.
RegionLayout KernelOperands::placedLayout(std::size_t gather, const RegionLayout& region) const {
  const Placement& placement = arguments_[gather].region.placement;
  if (isPlaced()) {
    Box box = boxOrAll(box_, shape_);
    for (int d = 0; d < box.begin.rank(); ++d) {
      box.begin[d] += place_.origin[d];
      box.end[d] += place_.origin[d];
    }
    if (isReadAsHeld({kernel_, arguments_, {}, specs_, place_.whole, plan_}, gather, box)) {
      const RegionLayout local = localLayout(region, placement, place_.origin);
      const bool arePacked = domain_.packed && region.packed;
      if (!arePacked || local.place.low[0] % assemble::lanes == 0) return local;
    }
  }
  return gatherLayout(region, placement, kernel_.parameters[gather].boundary);
}

}  // namespace sk
