// SPDX-License-Identifier: MIT
#include "assemble/program/texture_units.hpp"

#include <algorithm>

namespace sk::assemble {

using program::Parameter;
using program::Role;

std::size_t textureUnits(const program::Kernel& kernel, const SpecValues& specs, const OtherUnits& others) {
  std::size_t units = bundlesOf(kernel).size() + others.all();
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role != Role::Input && parameter.role != Role::Gather) continue;
    if (!isNeeded(parameter, specs)) continue;
    units +=
        parameter.layers.empty()
            ? heldBy(parameter).fields.size()
            : static_cast<std::size_t>(std::ranges::count(parameter.layers, -1, &program::Layer::bundle));
  }
  return units;
}

std::vector<std::size_t> bundlesOf(const program::Kernel& kernel) {
  std::vector<std::size_t> bundles;
  for (const Parameter& parameter : kernel.parameters) {
    for (const program::Layer& layer : parameter.layers) {
      if (layer.bundle >= 0) bundles.push_back(static_cast<std::size_t>(layer.bundle));
    }
  }
  std::ranges::sort(bundles);
  bundles.erase(std::unique(bundles.begin(), bundles.end()), bundles.end());
  return bundles;
}

std::size_t accumulatorPlanes(const program::Kernel& kernel) {
  std::size_t planes = 0;
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role == Role::Accumulator) planes += parameter.element->fields.size();
  }
  return planes;
}

}  // namespace sk::assemble
