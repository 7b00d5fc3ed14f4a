// SPDX-License-Identifier: MIT
#include "web/shadow_forms.hpp"

#include <fmt/format.h>

#include "web/offered.hpp"

namespace skc::web {

ShadowKernel::ShadowKernel(const sk::program::Kernel& wide)
    : parameters_(wide.parameters.begin(), wide.parameters.end()), kernel_(wide) {
  for (sk::program::Parameter& parameter : parameters_) parameter.held = nullptr;
  kernel_.parameters = parameters_;
  kernel_.plans = nullptr;  // they count the planes of floats
  kernel_.planCount = 0;
}

std::string whyNotBeside(const ShadowKernel& kernel) {
  if (!isTooLarge(kernel.get())) return {};
  const sk::assemble::Profile profile = webProfile();
  return fmt::format(
      "its streams of doubles have more planes than the {} to write or the {} to read of a pass; divide it",
      profile.drawBuffers, profile.textureUnits);
}

}  // namespace skc::web
