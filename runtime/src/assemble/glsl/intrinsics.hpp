// SPDX-License-Identifier: MIT
//
// The meaning of a program::Intrinsic in a kernel's text: our own functions, which are the same on every
// device, or the device's functions under our names. Only those that a kernel calls are defined.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "sk/program.hpp"

namespace sk::assemble {

/// For example "sk_sin".
std::string_view name(program::Intrinsic intrinsic);

struct IntrinsicTexts {
  std::string definitions;  ///< self-contained, except for exact_sums.hpp
  bool useExactFloats = false;  ///< they use sk_precise and sk_keep() of exact_sums.hpp
};

/// If accurate: within 3 ulp over the whole range, with the special cases of C99 (annex F) and, for minima
/// and maxima, of IEEE 754; docs/accuracy.md has the details of each. Otherwise the device's own.
IntrinsicTexts intrinsicTexts(std::span<const program::IntrinsicUse> uses, bool accurate);

}  // namespace sk::assemble
