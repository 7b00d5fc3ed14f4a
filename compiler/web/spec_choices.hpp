// SPDX-License-Identifier: MIT
//
// Which streams a kernel needs depends on the values of its Spec parameters, and each set of streams needs programs of its
// own. Finds one choice of values for each of these sets.
#pragma once

#include <cstddef>
#include <vector>

#include "assemble/assemble.hpp"
#include "sk/program.hpp"

namespace skc::web {

/// The most sets of streams for which programs are assembled.
inline constexpr std::size_t mostStreamSets = 256;

/// Values of Spec parameters, one choice for each set of streams that a kernel may need; more than mostStreamSets choices if
/// there are more sets than that.
std::vector<sk::assemble::SpecValues> specChoices(const sk::program::Kernel& kernel);

}  // namespace skc::web
