// SPDX-License-Identifier: MIT
//
// copy-parts: a function that writes a part of a part of a variable gets a variable of its own, if the call has an expression, too.
//
//   f(s.items[i], g(x));       float part = s.items[i];
//                              f(part, g(x));
//                              s.items[i] = part;
//
// NVIDIA's GLSL compiler (580, seen on an H200) loses what the function on the left writes if `s` was copied from another
// struct and it expands a function in the arguments, such as g or clamp().
//
// It preserves the meaning of kernels: such parameters are copied in and out anyway. The lvalues that a call writes do not
// overlap, and no index in them reads what it writes (ir::validate), so that the assignment finds the place again.
#pragma once

#include "ir/ir.hpp"
#include "support/diagnostics.hpp"

namespace skc {

void copyParts(ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc
