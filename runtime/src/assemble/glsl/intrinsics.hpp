// SPDX-License-Identifier: MIT
//
// What a kernel's text means by an intrinsic of program::Intrinsic: functions of ours, the same on every device,
// or the device's own under our names. Only those that a kernel calls are defined.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "sk/program.hpp"

namespace sk::assemble {

/// "sk_sin".
std::string_view name(program::Intrinsic intrinsic);

struct IntrinsicTexts {
  std::string definitions;  ///< they need nothing that stands before them but what is told here
  bool useExactFloats = false;  ///< sk_precise and sk_keep() of exact_sums.hpp
};

/// Accurate: within 3 ulp over the whole range, with the special cases of C99 (annex F) and, for minima and the like,
/// those of IEEE 754; docs/accuracy.md says of each what holds. Else the device's own.
IntrinsicTexts intrinsicTexts(std::span<const program::IntrinsicUse> uses, bool accurate);

/// Characters of the accurate functions that a kernel's body calls, with all that they need, each as often as it is called: drivers
/// put a copy wherever there is a call.
std::size_t lengthOfCalls(const program::Kernel& kernel);

}  // namespace sk::assemble
