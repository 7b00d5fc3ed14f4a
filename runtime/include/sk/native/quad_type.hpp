// SPDX-License-Identifier: MIT
//
// The type behind quad.hpp, for code that only stores such numbers: compilers convert and add them without a
// library.
#pragma once

namespace sk::native {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 Quad;
#else
using Quad = long double;
#endif

}  // namespace sk::native
