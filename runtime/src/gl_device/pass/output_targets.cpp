// SPDX-License-Identifier: MIT
//
// Chooses in-place, swap or copy for each output.
#include "gl_device/pass/output_targets.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "assemble/elements/planes.hpp"
#include "device/region.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/pass.hpp"

namespace sk {

using assemble::RegionLayout;
using program::Role;

namespace {

/// Whether the texels that are drawn for a region have its elements alone: those of a linearised stream are drawn from
/// the first to the last.
bool areDrawnAlone(const RegionLayout& region) {
  if (!region.linear) return true;
  std::int64_t span = 1, elements = 1;
  for (std::size_t d = 0; d < region.extent.size(); ++d) {
    span += std::int64_t{region.extent[d] - 1} * region.stride[d];
    elements *= region.extent[d];
  }
  return span == elements;
}

}  // namespace

OutputTargets::OutputTargets(GlDevice& device, const program::Kernel& kernel,
                             std::span<const Argument> arguments, const assemble::SpecValues& specs,
                             std::span<const Operand> operands, const RegionLayout& domain,
                             const Layout& layout, const Box& box)
    : device_(device),
      kernel_(kernel),
      arguments_(arguments),
      specs_(specs),
      operands_(operands),
      domain_(domain),
      layout_(layout),
      box_(box) {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (!isOutput(i)) {
      continue;
    }
    if (placementOf(i) != Placement::Direct) {
      addNewPlanes(i);
      continue;
    }
    drawnInPlace_.add(arguments_[i].region.stream);
    for (RenderTarget& plane : operands_[i].planes) {
      add(plane);
    }
  }
}

OutputTargets::Placement OutputTargets::placementOf(std::size_t output) const {
  bool isAlsoRead = false;
  bool isWrittenBefore = false;
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    const Role role = kernel_.parameters[i].role;
    const bool isSame = arguments_[i].region.stream == arguments_[output].region.stream;
    const bool isRead = role == Role::Input || role == Role::Gather || role == Role::Uniform;
    isAlsoRead = isAlsoRead || (isSame && isNeeded(i) && isRead);
    isWrittenBefore = isWrittenBefore || (isSame && isOutput(i) && i < output);
  }
  const RegionLayout& regionLayout = operands_[output].regionLayout;
  const bool isSame =
      haveSameTexels(regionLayout, domain_) && (box_.isWhole() || areDrawnAlone(drawnPart(output)));
  if (!isWrittenBefore && isSame && !isAlsoRead) {
    return Placement::Direct;
  }
  // a stream that is seen in another shape keeps its planes, and one that is not takes none of another shape
  const StreamRegion& region = arguments_[output].region;
  const bool isOfShape = isBox(region) && layout_.whole.extent == xFirst(region.stream->shape);
  const bool isWhole = !regionLayout.view && !domain_.view && isOfShape && box_.isWhole();
  return isWhole && !isWrittenBefore ? Placement::Swap : Placement::Copy;
}

/// Adds new planes with the layout of the domain, and prepares the copy from there, so that it cannot fail
/// later.
void OutputTargets::addNewPlanes(std::size_t output) {
  const program::Element& held = glStream(arguments_[output].region).held();
  newPlanes_.resize(arguments_.size());
  const bool isSwapped = placementOf(output) == Placement::Swap;
  newPlanes_[output] = std::make_unique<NewPlanes>(device_);
  if (isSwapped) newPlanes_[output]->layout = layout_;
  PlanesLease& drawn = newPlanes_[output]->drawn;
  drawn.add(domain_.packed ? assemble::fourOf(held.fields.front().scalar) : held, layout_.texture,
            "an output that the kernel reads too");
  for (RenderTarget& plane : drawn.planes) {
    add(plane);
  }
  if (isSwapped) return;
  prepareCopy(device_, held, drawnPart(output), writtenPart(output));
  copied_.add(arguments_[output].region.stream);
}

RegionLayout OutputTargets::drawnPart(std::size_t output) const {
  return partOf(domain_, arguments_[output].region.shape.rank(), box_);
}
RegionLayout OutputTargets::writtenPart(std::size_t output) const {
  return partOf(operands_[output].regionLayout, arguments_[output].region.shape.rank(), box_);
}

std::vector<std::span<RenderTarget>> OutputTargets::planesOfOutputs() const {
  std::vector<std::span<RenderTarget>> planes(arguments_.size());
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (isOutput(i)) {
      const bool isNew = i < newPlanes_.size() && newPlanes_[i];
      planes[i] = isNew ? std::span<RenderTarget>(newPlanes_[i]->drawn.planes) : operands_[i].planes;
    }
  }
  return planes;
}

void OutputTargets::copy() {
  copied_.begin();
  for (std::size_t i = 0; i < newPlanes_.size(); ++i) {
    if (!newPlanes_[i] || placementOf(i) == Placement::Swap) continue;
    GlStream& stream = glStream(arguments_[i].region);
    copyRegion(device_, stream.held(), newPlanes_[i]->drawn.planes, drawnPart(i), stream.planes,
               writtenPart(i));
  }
}

void OutputTargets::exchange() noexcept {
  drawnInPlace_.commit();
  copied_.commit();
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (!isOutput(i)) continue;
    GlStream& stream = glStream(arguments_[i].region);
    if (i < newPlanes_.size() && newPlanes_[i] && placementOf(i) == Placement::Swap) {
      std::swap(stream.planes, newPlanes_[i]->drawn.planes);
      stream.layout = std::move(newPlanes_[i]->layout);
      stream.labelPlanes();
    }
    stream.setWritten();
  }
}

}  // namespace sk
