// SPDX-License-Identifier: MIT
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

#include <string>
#include <string_view>

#include "assemble/assemble.hpp"

namespace sk::assemble {

/// The #extension lines at the beginning of a program that uses doubles; each ends its line.
std::string_view doubleExtensions(Doubles form);
/// The definitions, which precede all others except, for pairs, those of own_arithmetic.hpp. Operations of native doubles are
/// precise with that barrier (barrierOfBodies()), which needs exactExtensions().
std::string doubleDefinitions(Doubles form, Barrier own);

}  // namespace sk::assemble
