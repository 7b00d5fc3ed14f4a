// SPDX-License-Identifier: MIT
#include "web/offered.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "assemble/append/append_passes.hpp"
#include "assemble/program/texture_units.hpp"
#include "program/stream_structs.hpp"
#include "web/ahead_programs.hpp"
#include "web/spec_choices.hpp"
#include "web/sum_variants.hpp"

namespace skc::web {
namespace {

using sk::program::Kernel;
using sk::program::Parameter;
using sk::program::Role;

/// What append outputs add: a list's planes and target texels, the counts that the other outputs are drawn with, and the
/// textures of the pyramid.
bool fitsAppendPasses(const Kernel& kernel, const sk::assemble::PassLimits& limits,
                      const sk::assemble::SpecValues& specs) {
  int written = 0, read = 0, pyramid = 0;
  for (const Parameter& parameter : kernel.parameters) {
    const int planes = static_cast<int>(heldBy(parameter).fields.size());
    if (sk::assemble::isAppendOutput(parameter)) {
      const bool isCounted = sk::assemble::isCounted(parameter);
      written += isCounted ? 1 : 0;
      pyramid = isCounted ? 2 : pyramid;
      if (planes + (parameter.role == Role::Scatter ? 1 : 0) > limits.drawBuffers) return false;
    } else if (sk::assemble::isNeeded(parameter, specs)) {
      if (parameter.role == Role::Output) written += planes;
      if (parameter.role == Role::Input || parameter.role == Role::Gather) read += planes;
    }
  }
  return written <= limits.drawBuffers && read + pyramid <= limits.textureUnits;
}

bool fitsOnePass(const Kernel& kernel, const sk::assemble::Profile& profile) {
  const sk::assemble::PassLimits limits{profile.drawBuffers, profile.textureUnits};
  if (hasAppendOutputs(kernel)) {
    return std::ranges::all_of(specChoices(kernel), [&](const sk::assemble::SpecValues& specs) {
      return fitsAppendPasses(kernel, limits, specs);
    });
  }
  return std::ranges::all_of(specChoices(kernel), [&](const sk::assemble::SpecValues& specs) {
    return sk::assemble::fitsOnePass(kernel, limits, specs);
  });
}

}  // namespace

bool hasAppendOutputs(const Kernel& kernel) {
  return std::ranges::any_of(kernel.parameters, sk::assemble::isAppendOutput);
}

const sk::program::Plan* planOf(const Kernel& kernel) {
  const sk::assemble::Profile profile = webProfile();
  if (hasAppendOutputs(kernel) || fitsOnePass(kernel, profile)) return nullptr;
  return sk::assemble::planWithin(kernel, {profile.drawBuffers, profile.textureUnits});
}

bool isTooLarge(const Kernel& kernel) {
  return !fitsOnePass(kernel, webProfile()) && planOf(kernel) == nullptr;
}

sk::assemble::Profile webProfile() {
  sk::assemble::Profile profile = *sk::assemble::findProfile("webgl2");
  profile.tables = false;
  return profile;
}

namespace {

std::string whyTooLarge(const Kernel& kernel) {
  const sk::assemble::Profile profile = webProfile();
  if (fitsOnePass(kernel, profile) || planOf(kernel) != nullptr) return {};
  return fmt::format(
      "its streams have more than {} planes to write or {} to read, and no passes "
      "of these sizes compute it; divide it, or put scalars together in vectors",
      profile.drawBuffers, profile.textureUnits);
}

}  // namespace

std::string whyNestsTooDeep(const ir::Module& module, const ir::Kernel& kernel) {
  constexpr int most = 4;  // by the specification of WebGL
  const int levels = emit::structLevels(module, kernel);
  if (levels <= most) return {};
  return fmt::format(
      "its structs are nested {} levels deep, but WebGL takes {}; a double or a long is a struct there, too; "
      "put "
      "members of the "
      "inner structs into the outer ones",
      levels, most);
}

namespace {

std::string whyTooManyStreamSets(const Kernel& kernel) {
  if (specChoices(kernel).size() <= mostStreamSets) return {};
  return fmt::format(
      "the values of its specialisation constants choose among more than {} sets of streams, each of which "
      "would "
      "need a program of its own; divide it, or let it read more of the streams in any case",
      mostStreamSets);
}

}  // namespace

std::string whyNotOffered(const ir::Module& module, const emit::Unit& unit) {
  const Kernel& kernel = unit.kernel;
  if (std::string why = whyTooManyStreamSets(kernel); !why.empty()) return why;
  if (std::string why = whyNestsTooDeep(module, module.kernels[unit.id]); !why.empty()) return why;
  if (unit.reduction != nullptr) {
    if (std::string why = whyTooManyPlanes(*unit.reduction, unit.isScan); !why.empty()) return why;
    return unit.reduction->parts == nullptr ? std::string() : whyTooLarge(unit.reduction->parts->map);
  }
  const sk::assemble::Profile profile = webProfile();
  if (hasAppendOutputs(kernel) && !fitsOnePass(kernel, profile)) {
    return fmt::format(
        "a pass of it has more than {} planes to write or {} to read, with those of what it pushes or "
        "scatters; divide it, or put "
        "scalars together in vectors",
        profile.drawBuffers, profile.textureUnits);
  }
  return whyTooLarge(kernel);
}

}  // namespace skc::web
