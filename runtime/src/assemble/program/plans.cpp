// SPDX-License-Identifier: MIT
#include "assemble/program/plans.hpp"

#include <cstddef>
#include <span>

#include "assemble/program/texture_units.hpp"

namespace sk::assemble {

using program::Role;

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
