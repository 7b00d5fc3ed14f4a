// SPDX-License-Identifier: MIT
//
// The functions of functions.def, numbered as in functions.sk.
#pragma once

namespace sk_tool {

enum Function : unsigned {
#define SK_FUNCTION(name) f_##name,
#define SK_RANGE(name, spread, low, high)
#define SK_FUNCTION2(name) f_##name,
#define SK_RANGE2(name, spread, low, high, spread2, low2, high2)
#include "info/functions.def"
};

}  // namespace sk_tool
