// SPDX-License-Identifier: MIT
//
// Functions of doubles that GLSL lacks: sines, exponentials and others of one sk_double, for native doubles and for pairs of
// floats. Only functions that a kernel calls are defined; the kernel's body has the functions of vectors. They consist of
// pieces, which functions share, and of polynomials, whose text serves both representations.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// In order of definition: each needs only earlier ones.
enum class Piece : std::uint8_t {
  ExpTail,
  ExpReduced,
  LogTail,
  Log,
  LogPlus,
  Power,
  ReduceLarge,
  Wave,
  Angle,
};
using Pieces = std::uint32_t;
template <class... P>
constexpr Pieces pieces(P... all) {
  return (Pieces{0} | ... | (Pieces{1} << static_cast<unsigned>(all)));
}

/// The pieces of a set and their dependencies, after the few functions that use bits, which are always
/// included.
std::string doublePieces(Pieces set, Doubles form, Barrier barrier);

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
/// Its definition, by Horner's rule; for pairs with sk_step() (double_pieces.glsl), for which each coefficient
/// must exceed the sum of the higher terms.
std::string polynomialText(Doubles form, const Polynomial& polynomial);

/// Whether a kernel calls any of them with a double.
bool callDoubleIntrinsics(std::span<const program::IntrinsicUse> uses);

/// Their definitions, which must follow those of doubles.hpp and of own_arithmetic.hpp for the same barrier.
/// Errors are a few 2^-53 for native doubles, below 2^-45 for pairs, with the special cases of C99 (annex F);
/// docs/accuracy.md has the details of each.
std::string doubleIntrinsicDefinitions(std::span<const program::IntrinsicUse> uses, Doubles form,
                                       Barrier barrier);

}  // namespace sk::assemble
