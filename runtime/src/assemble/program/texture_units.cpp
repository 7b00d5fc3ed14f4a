// SPDX-License-Identifier: MIT
#include "assemble/program/texture_units.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

namespace sk::assemble {

using program::Parameter;
using program::Role;

std::size_t textureUnits(const program::Kernel& kernel, const SpecValues& specs, const OtherUnits& others) {
  std::size_t units = stacksOf(kernel).size() + others.all();
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role != Role::Input && parameter.role != Role::Gather) continue;
    if (!isNeeded(parameter, specs)) continue;
    units += parameter.layers.empty()
                 ? heldBy(parameter).fields.size()
                 : static_cast<std::size_t>(std::ranges::count(parameter.layers, -1, &program::Layer::stack));
  }
  return units;
}

std::vector<std::size_t> stacksOf(const program::Kernel& kernel) {
  std::vector<std::size_t> stacks;
  for (const Parameter& parameter : kernel.parameters) {
    for (const program::Layer& layer : parameter.layers) {
      if (layer.stack >= 0) stacks.push_back(static_cast<std::size_t>(layer.stack));
    }
  }
  std::ranges::sort(stacks);
  stacks.erase(std::unique(stacks.begin(), stacks.end()), stacks.end());
  return stacks;
}

std::size_t accumulatorPlanes(const program::Kernel& kernel) {
  std::size_t planes = 0;
  for (const Parameter& parameter : kernel.parameters) {
    if (parameter.role == Role::Accumulator) planes += parameter.element->fields.size();
  }
  return planes;
}

bool fitsOnePass(const program::Kernel& kernel, const PassLimits& limits, const SpecValues& specs) {
  std::size_t written = 0;
  for (const program::Parameter& parameter : kernel.parameters) {
    if (!isNeeded(parameter, specs)) continue;
    if (parameter.role == Role::Output) written += heldBy(parameter).fields.size();
  }
  return written <= static_cast<std::size_t>(limits.drawBuffers) &&
         textureUnits(kernel, specs) <= static_cast<std::size_t>(limits.textureUnits);
}

const program::Plan* planWithin(const program::Kernel& kernel, const PassLimits& limits) {
  for (const program::Plan& plan : std::span(kernel.plans, kernel.planCount)) {
    if (plan.drawBuffers <= limits.drawBuffers && plan.textureUnits <= limits.textureUnits) return &plan;
  }
  return nullptr;
}

}  // namespace sk::assemble
