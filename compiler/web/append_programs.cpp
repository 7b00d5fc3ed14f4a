// SPDX-License-Identifier: MIT
//
// Programs of the lists of variable and scatter outputs. Elements are found by their number, so that no input is aligned.
#include "web/ahead_programs.hpp"

namespace skc::web {

using sk::assemble::Addressing;
using sk::assemble::Domain;
using sk::assemble::SpecValues;
using sk::assemble::StreamAccess;
using sk::assemble::Variant;
using sk::assemble::Work;
using sk::program::Kernel;
using sk::program::Parameter;
using sk::program::Role;

Programs listPrograms(const sk::assemble::Profile& profile, const Kernel& kernel, std::size_t appendOutput) {
  Programs programs;
  for (const SpecValues& specs : specChoices(kernel)) {
    for (const Lie& lie : liesOf(kernel)) {
      if (lie.packed) continue;
      Variant variant;
      variant.task = {.work = Work::List, .appendOutput = static_cast<std::uint8_t>(appendOutput)};
      variant.specs = specs;
      variant.domain = Domain::Entry;
      variant.domainRank = lie.domain == Domain::Linear && lie.rank == 1 ? 1 : 4;
      for (std::vector<StreamAccess>& access : accessChoices(kernel, lie, false)) {
        variant.access = std::move(access);
        for (std::size_t i = 0; i < kernel.parameters.size(); ++i) {
          const Parameter& parameter = kernel.parameters[i];
          const bool isPlane =
              parameter.role == Role::Input ? lie.domain == Domain::Plane : parameter.rank == 2;
          if (parameter.role == Role::Input || parameter.role == Role::Scatter)
            variant.access[i] = {.addressing = isPlane ? Addressing::Plane : Addressing::Linear};
        }
        const std::string key = keyOf(kernel, variant);
        if (!programs.contains(key))
          programs.emplace(key, sk::assemble::kernelProgram(profile, kernel, variant));
      }
    }
  }
  return programs;
}

}  // namespace skc::web
