// SPDX-License-Identifier: MIT
#include "web/offered.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/program/plans.hpp"
#include "web/ahead_programs.hpp"

namespace skc::web {
namespace {

using sk::program::Kernel;
using sk::program::Parameter;
using sk::program::Role;

bool has(const Kernel& kernel, Role role) {
  return std::ranges::find(kernel.parameters, role, &Parameter::role) != kernel.parameters.end();
}

bool fitsOnePass(const Kernel& kernel, const sk::assemble::Profile& profile) {
  const sk::assemble::PassLimits limits{profile.drawBuffers, profile.textureUnits};
  return std::ranges::all_of(specChoices(kernel), [&](const sk::assemble::SpecValues& specs) {
    return sk::assemble::fitsOnePass(kernel, limits, specs);
  });
}

}  // namespace

const sk::program::Plan* planOf(const Kernel& kernel) {
  const sk::assemble::Profile profile = webProfile();
  if (fitsOnePass(kernel, profile)) return nullptr;
  const sk::program::Plan* plan =
      sk::assemble::planWithin(kernel, {profile.drawBuffers, profile.textureUnits});
  return plan != nullptr && plan->bundles.empty() ? plan : nullptr;
}

sk::assemble::Profile webProfile() {
  sk::assemble::Profile profile = *sk::assemble::findProfile("webgl2");
  profile.tables = false;
  return profile;
}

std::string whyNotOffered(const emit::Unit& unit) {
  const sk::assemble::Profile profile = webProfile();
  const Kernel& kernel = unit.kernel;
  if (unit.isScan)
    return "scans do not run in browsers yet; fold with a reduce, or scan the elements on the host";
  if (has(kernel, Role::VariableOutput)) {
    return "variable outputs do not run in browsers yet; write every element with a mark, and select on the "
           "host";
  }
  if (has(kernel, Role::Scatter)) {
    return "scatter outputs do not run in browsers yet; gather from a stream of indices instead";
  }
  if (unit.reduction != nullptr && unit.reduction->parts != nullptr) {
    return "folded outputs do not run in browsers yet; write a kernel and a reduce";
  }
  if (!fitsOnePass(kernel, profile) && planOf(kernel) == nullptr) {
    return fmt::format(
        "its streams have more than {} planes to write or {} to read, and passes that share textures do not "
        "run in browsers yet; divide it, or put scalars together in vectors",
        profile.drawBuffers, profile.textureUnits);
  }
  return {};
}

}  // namespace skc::web
