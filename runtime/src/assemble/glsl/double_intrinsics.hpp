// SPDX-License-Identifier: MIT
//
// Functions of doubles that GLSL lacks: sines, exponentials and others of one sk_double, for native doubles
// and for pairs of floats. Only functions that a kernel calls are defined; the kernel's body has the
// functions of vectors.
#pragma once

#include <span>
#include <string>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// Whether a kernel calls any of them with a double.
bool callDoubleIntrinsics(std::span<const program::IntrinsicUse> uses);

/// Their definitions, which must follow those of doubles.hpp and of exact_sums.hpp for the same barrier.
/// Errors are a few 2^-53 for native doubles, below 2^-45 for pairs, with the special cases of C99 (annex F);
/// docs/accuracy.md has the details of each.
std::string doubleIntrinsicDefinitions(std::span<const program::IntrinsicUse> uses, Doubles form,
                                       Barrier barrier);

}  // namespace sk::assemble
