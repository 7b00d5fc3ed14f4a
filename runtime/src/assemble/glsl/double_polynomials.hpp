// SPDX-License-Identifier: MIT
//
// Numbers and polynomials of doubles as text for either form: what the functions of double_intrinsics.hpp are made of. It
// knows no function but by its polynomial.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// `sk_double(...)` of a finite number: of a pair, the nearest.
std::string doubleConstant(Doubles form, double value);
/// A text in which each `D(number)` is replaced by that.
std::string withConstants(Doubles form, std::string_view text);

/// `sk_double name(sk_double x)`, or `sk_double name(sk_double x, bool other)` where there are two lists, which
/// are equally long. Lowest powers first. Of pairs, only the first `exact` coefficients are such; what the
/// others add is so small that floats will do.
struct Polynomial {
  std::string_view name;
  std::size_t exact;
  std::span<const double> coefficients, others = {};
};
/// Its definition, by Horner's rule; of pairs by way of sk_step() (double_intrinsics.cpp), to which each coefficient must
/// be larger than what stands for those above it.
std::string polynomialText(Doubles form, const Polynomial& polynomial);

}  // namespace sk::assemble
