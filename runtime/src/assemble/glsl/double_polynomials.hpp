// SPDX-License-Identifier: MIT
//
// Constants and polynomials of doubles as text for either representation. Must not depend on the functions
// that they approximate.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// `sk_double(...)` for a finite number; the nearest pair.
std::string doubleConstant(Doubles form, double value);
/// The text with each `D(number)` replaced by its doubleConstant.
std::string withConstants(Doubles form, std::string_view text);

/// Defines `sk_double name(sk_double x)`, or `sk_double name(sk_double x, bool other)` if there are two
/// lists, of equal length. Lowest powers first. In pairs, only the first `exact` coefficients are pairs; the
/// terms of the others are so small that floats suffice.
struct Polynomial {
  std::string_view name;
  std::size_t exact;
  std::span<const double> coefficients, others = {};
};
/// Its definition, by Horner's rule; for pairs with sk_step() (double_pieces.cpp), for which each coefficient
/// must exceed the sum of the higher terms.
std::string polynomialText(Doubles form, const Polynomial& polynomial);

}  // namespace sk::assemble
