// SPDX-License-Identifier: MIT
#include "driver/glsl_listing.hpp"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <set>

#include "assemble/assemble.hpp"
#include "assemble/plans.hpp"
#include "assemble/reduce_plan.hpp"
#include "assemble/reduce_program.hpp"

namespace skc::driver {
namespace {

using sk::assemble::Profile;

/// The variant of streams that lie as they are and share one shape, as most calls have it. Spec
/// parameters are true or 1.
sk::assemble::Variant plainVariant(const sk::program::Kernel& kernel) {
  sk::assemble::Variant variant;
  std::size_t specs = 0;
  for (const sk::program::Parameter& parameter : kernel.parameters) {
    sk::assemble::StreamAccess access;
    if (parameter.role == sk::program::Role::Gather) {
      access.addressing = sk::assemble::Addressing::Plane;
      access.nearby = parameter.reach >= 0;
    } else if (parameter.role == sk::program::Role::Iterator) {
      const bool isScalar = parameter.element->fields.front().width == 1;
      if (isScalar) access.addressing = sk::assemble::Addressing::Linear;
    } else if (parameter.role == sk::program::Role::Spec) {
      const bool isFloat = parameter.element->fields.front().scalar == sk::program::Scalar::Float;
      variant.specs[specs++] = isFloat ? std::bit_cast<std::uint32_t>(1.0F) : 1u;
    }
    variant.access.push_back(access);
  }
  return variant;
}

/// Every program that folds a 1024 x 1024 stream to a value, once.
std::string reductionListing(const Profile& profile, const sk::program::Reduction& reduction) {
  sk::assemble::Placement input;
  input.extent = {1024, 1024, 1, 1};
  std::string text;
  std::set<sk::assemble::ReduceVariant> seen;
  for (const sk::assemble::ReducePass& pass :
       sk::assemble::planReduction(input, sk::assemble::valuePlacement(), {.textureSize = 16384})) {
    if (!seen.insert(pass.variant).second) continue;
    if (!text.empty()) text += "\n";
    text += sk::assemble::reduceProgram(profile, reduction, pass.variant);
  }
  return text;
}

/// The programs of the passes that a kernel takes within the profile's limits.
std::string kernelListing(const Profile& profile, const sk::program::Kernel& kernel) {
  const sk::assemble::PassLimits limits{profile.drawBuffers, profile.textureUnits};
  const sk::program::Plan* plan = sk::assemble::planWithin(kernel, limits);
  if (plan == nullptr || sk::assemble::fitsOnePass(kernel, limits)) {
    return sk::assemble::fragmentProgram(profile, kernel, plainVariant(kernel));
  }
  std::string text;
  for (const sk::program::Pass& pass : plan->passes) {
    if (!text.empty()) text += "\n";
    text += sk::assemble::fragmentProgram(profile, pass.kernel, plainVariant(pass.kernel));
  }
  return text;
}

}  // namespace

std::string glslListing(const emit::Program& program, std::string_view profileName) {
  const Profile& profile = *sk::assemble::findProfile(profileName);
  std::string text;
  for (const emit::Unit& unit : program.units()) {
    if (!text.empty()) text += "\n";
    text += unit.reduction ? reductionListing(profile, *unit.reduction) : kernelListing(profile, unit.kernel);
  }
  return text;
}

}  // namespace skc::driver
