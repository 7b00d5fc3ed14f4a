// SPDX-License-Identifier: MIT
//
// The functions of doubles that GLSL does not have: sines, exponentials and the like of one sk_double, for GLSL's own doubles
// and for pairs of floats. Only those that a kernel calls are defined; those of vectors are in its body.
#pragma once

#include <span>
#include <string>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// Whether any of them is called with a double.
bool callDoubleIntrinsics(std::span<const program::IntrinsicUse> uses);

/// Their definitions, which stand behind those of doubles.hpp and of exact_sums.hpp for the same barrier. Of native
/// doubles within a few 2^-53, of pairs within 2^-45, with the special cases of C99 (annex F); docs/accuracy.md says of each what
/// holds.
std::string doubleIntrinsicDefinitions(std::span<const program::IntrinsicUse> uses, Doubles form,
                                       Barrier barrier);

}  // namespace sk::assemble
