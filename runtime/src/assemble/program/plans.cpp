// SPDX-License-Identifier: MIT
#include "assemble/program/plans.hpp"

#include <cstddef>
#include <span>

namespace sk::assemble {

using program::Role;

bool fitsOnePass(const program::Kernel& kernel, const PassLimits& limits, const SpecValues& specs) {
  std::size_t written = 0;
  std::size_t read = 0;
  for (const program::Parameter& parameter : kernel.parameters) {
    if (!isNeeded(parameter, specs)) continue;
    const bool isRead = parameter.role == Role::Input || parameter.role == Role::Gather;
    if (isRead) read += heldBy(parameter).fields.size();
    if (parameter.role == Role::Output) written += heldBy(parameter).fields.size();
  }
  return written <= static_cast<std::size_t>(limits.drawBuffers) &&
         read <= static_cast<std::size_t>(limits.textureUnits);
}

const program::Plan* planWithin(const program::Kernel& kernel, const PassLimits& limits) {
  for (const program::Plan& plan : std::span(kernel.plans, kernel.planCount)) {
    if (plan.drawBuffers <= limits.drawBuffers && plan.textureUnits <= limits.textureUnits) return &plan;
  }
  return nullptr;
}

}  // namespace sk::assemble
