// SPDX-License-Identifier: MIT
//
// The meaning of integers of 64 bits in a kernel's text: the types sk_long to sk_long4 and sk_ulong to sk_ulong4, and the functions
// of one such integer that bodies call, on all devices in two words.
//
//   sk_long sk_to_long(int | uint | float | sk_double | sk_ulong)    int sk_to_int(x)  uint sk_to_uint(x)  float sk_to_float(x)
//   sk_long sk_neg(x)  sk_inverse(x)  sk_add(x, y)  sk_sub  sk_mul  sk_div  sk_rem  sk_and  sk_or  sk_xor  sk_mulhi
//   sk_long sk_div_by(x, uint below 2^24)  sk_rem_by
//   sk_long sk_shl(x, int | uint)  sk_shr                            bool sk_less(x, y)  sk_equal
//   int sk_popcount(x)  sk_clz  sk_ctz                               sk_long sk_choose(bool, x, y)
#pragma once

#include <string>

namespace sk::assemble {

/// The text of all of them. `besideDoubles`: the program has doubles, too (double_intrinsics.hpp), which precede this text.
std::string longDefinitions(bool besideDoubles);

}  // namespace sk::assemble
