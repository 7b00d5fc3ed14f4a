// SPDX-License-Identifier: MIT
//
// Functions of doubles that GLSL lacks: sines, exponentials and others of one sk_double, for native doubles and for pairs of
// floats. Only functions that a kernel calls are defined; the kernel's body has the functions of vectors. They consist of
// pieces, which functions share, and of polynomials, whose text serves both representations.
//
// The meaning of doubles in a kernel's text: the types sk_double to sk_double4 and the functions of one
// sk_double that bodies call, for native doubles or for pairs of floats.
//
//   sk_double sk_to_double(float | int | uint)    float sk_to_float(x)   int sk_to_int(x)   uint sk_to_uint(x)
//   sk_double sk_neg(x)  sk_add(x, y)  sk_sub  sk_mul  sk_div            bool sk_less(x, y)  sk_less_equal  sk_equal
//   sk_double sk_abs(x)  sk_floor(x)  sk_trunc(x)  sk_round(x)  sk_sqrt(x)  sk_ldexp(x, int)
//                                                                        bool sk_isnan(x)  sk_isinf(x)
//   sk_double sk_choose(bool, x, y)    WebGL has no `?:` of structs
//   sk_double sk_unpack(uvec2 bits)  sk_double2 sk_unpack(uvec4 bits)    uvec2 sk_pack(x)   uvec4 sk_pack(sk_double2)
//
// Streams hold the 64 bits of IEEE 754 doubles in either representation, lower half first.
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
  ErrorNear0,
  ErrorTail,
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
  bool isUneven = false;  ///< a coefficient may be less than the sum of the higher terms
};
/// Its definition, by Horner's rule; for pairs with sk_step() (double_pieces.glsl), for which each coefficient
/// must exceed the sum of the higher terms, unless it is uneven.
std::string polynomialText(Doubles form, const Polynomial& polynomial);

/// Whether a kernel calls any of them with a double.
bool callDoubleIntrinsics(std::span<const program::IntrinsicUse> uses);

/// Their definitions, which must follow those of doubles.hpp and of own_arithmetic.hpp for the same barrier.
/// Errors are a few 2^-53 for native doubles, below 2^-45 for pairs, with the special cases of C99 (annex F);
/// docs/accuracy.md has the details of each.
std::string doubleIntrinsicDefinitions(std::span<const program::IntrinsicUse> uses, Doubles form,
                                       Barrier barrier);

/// The #extension lines at the beginning of a program that uses doubles; each ends its line.
std::string_view doubleExtensions(Doubles form);
/// The definitions, which precede all others except, for pairs, those of own_arithmetic.hpp. Operations of native doubles are
/// precise with that barrier (barrierOfBodies()), which needs exactExtensions().
std::string doubleDefinitions(Doubles form, Barrier own);

}  // namespace sk::assemble
