// SPDX-License-Identifier: MIT
//
// The ways of outputs.
#include "output_targets.hpp"

#include <utility>

#include "gl_stream.hpp"
#include "pass.hpp"

namespace sk {

using assemble::Placement;
using program::Role;

OutputTargets::OutputTargets(GlDevice& device, const program::Kernel& kernel,
                             std::span<const Argument> arguments, const assemble::SpecValues& specs,
                             std::span<const Operand> operands, const Placement& domain, const Layout& layout)
    : device_(device),
      kernel_(kernel),
      arguments_(arguments),
      specs_(specs),
      operands_(operands),
      domain_(domain),
      layout_(layout) {
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (!isOutput(i)) {
      continue;
    }
    if (const Way way = wayOf(i); way != Way::Direct) {
      addAside(i, way);
      continue;
    }
    for (Surface& plane : operands_[i].planes) {
      add(plane);
    }
  }
}

OutputTargets::Way OutputTargets::wayOf(std::size_t output) const {
  bool isReadToo = false;
  bool isWrittenBefore = false;
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    const Role role = kernel_.parameters[i].role;
    const bool isSame = arguments_[i].region.stream == arguments_[output].region.stream;
    isReadToo = isReadToo || (isSame && isNeeded(i) && (role == Role::Input || role == Role::Gather));
    isWrittenBefore = isWrittenBefore || (isSame && isOutput(i) && i < output);
  }
  const Placement& placement = operands_[output].placement;
  if (isWrittenBefore || !haveSameTexels(placement, domain_)) {
    return Way::Copy;
  }
  return !isReadToo ? Way::Direct : placement.view ? Way::Copy : Way::Swap;
}

/// New planes lie as the domain does, or are those that the stream is to have.
void OutputTargets::addAside(std::size_t output, Way way) {
  const GlStream& stream = glStream(arguments_[output].region);
  const Layout& layout = way == Way::Swap ? stream.layout : layout_;
  aside_.resize(arguments_.size());
  aside_[output] = std::make_unique<PlanesLease>(device_);
  aside_[output]->planes =
      device_.takePlanes(stream.held(), layout.texture, "an output that the kernel reads too");
  for (Surface& plane : aside_[output]->planes) {
    add(plane);
  }
}

std::vector<std::span<Surface>> OutputTargets::planesOfOutputs() const {
  std::vector<std::span<Surface>> planes(arguments_.size());
  for (std::size_t i = 0; i < arguments_.size(); ++i) {
    if (isOutput(i)) {
      const bool isAside = i < aside_.size() && aside_[i];
      planes[i] = isAside ? std::span<Surface>(aside_[i]->planes) : operands_[i].planes;
    }
  }
  return planes;
}

void OutputTargets::putInPlace() {
  for (std::size_t i = 0; i < aside_.size(); ++i) {
    if (!aside_[i]) {
      continue;
    }
    GlStream& stream = glStream(arguments_[i].region);
    if (wayOf(i) == Way::Swap) {
      std::swap(stream.planes, aside_[i]->planes);
      stream.labelPlanes();
    } else {
      copyRegion(device_, stream.held(), aside_[i]->planes, domain_, stream.planes, operands_[i].placement);
    }
  }
}

}  // namespace sk
