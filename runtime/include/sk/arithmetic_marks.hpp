// SPDX-License-Identifier: MIT
//
// Marks in the GLSL of a kernel's body (sk/program.hpp) that say where floats are computed. The assembler replaces them by
// what keeps a driver's compiler from reordering, combining or contracting these operations, or removes them. A mark begins
// with `$`, which is no character of GLSL.
#pragma once

#include <string_view>

namespace sk::program::mark {

/// In front of the type of a variable that holds floats: `precise`, or nothing.
inline constexpr std::string_view declared = "$p";
/// Around one operation of floats or vectors of them: `sk_keep(...)`, or nothing.
inline constexpr std::string_view operation = "$(", operationEnd = "$)";
/// The same around an operation in brackets, which `sk_keep(...)` replaces.
inline constexpr std::string_view bracketed = "$[", bracketedEnd = "$]";
/// Around an expression whose value goes to no variable of the function: its value is assigned to a precise variable there, or
/// nothing. A digit follows: the width of a vector, or 5, 6 and 7 for matrices of 2, 3 and 4 columns.
inline constexpr std::string_view value = "$v", valueEnd = "$;";
/// `$= PLACE $, OPERATOR $, VALUE $.`: a compound assignment.
inline constexpr std::string_view compound = "$=", compoundNext = "$,", compoundEnd = "$.";
/// Around an operand that may be 0 and whose value a compiler may know, such as a constant, or that is the other operand, too: a
/// function that hides it, or nothing. Compilers take `x + 0.0` for x, which is not so for -0, and `x * 0.0` and `x - x` for 0, which
/// is not so for infinities, some of them (Mesa's) even where `precise` forbids it.
inline constexpr std::string_view known = "$<", knownEnd = "$>";
/// The literal 0, hidden likewise, or `0.0`.
inline constexpr std::string_view zero = "$0";
/// In front of the name of GLSL's dot, cross, reflect, refract or faceforward: `sk_exact_`, which makes it the name of ours, or
/// nothing.
inline constexpr std::string_view function = "$f";
/// `$m FACTOR $* FACTOR $#`: a product of matrices, or of a vector and a matrix: a call of ours, or GLSL's operator.
inline constexpr std::string_view product = "$m", times = "$*", productEnd = "$#";
/// In front of the brackets around a comparison of floats that is negated: `!`, or a function of ours. NVIDIA's compiler for ES (580)
/// takes `!(x < y)` for `x >= y`, which differs where there is NaN. The second one stands for GLSL's `not`, of vectors.
inline constexpr std::string_view negation = "$!", vectorNegation = "$~";
/// Around an integer in a float, n / (2^b - 1) of a normalized type: a function of ours that rounds correctly, or GLSL's division, which
/// some devices round otherwise. The bits follow, a digit or more, and `$`.
inline constexpr std::string_view fraction = "$q", fractionEnd = "$Q", fractionBitsEnd = "$";
/// Around a divisor that a compiler may know, so that it might multiply by its rounded reciprocal: a function that hides it where
/// GLSL has no `precise`, or nothing.
inline constexpr std::string_view divisor = "$/", divisorEnd = "$|";

}  // namespace sk::program::mark
