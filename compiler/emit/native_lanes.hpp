// SPDX-License-Identifier: MIT
//
// The second form of a kernel that native_code.hpp prints: neighbours along x side by side, each in a lane of vectors, over the
// classes of sk/native/lanes.hpp (as ispc does it: M. Pharr and W. R. Mark, "ispc: a SPMD compiler for high-performance CPU
// programming", 2012). What is the same for all lanes stays a scalar, and so do the branches and loops that it decides. Where
// lanes part, masks say who goes on:
//
//   while (steps < most && f(z)) {                 native::Mask sk_on1(true);
//     z = g(z);                                    for (;;) {
//     ++steps;                             ->        sk_on1 = sk_on1 & (steps < most & sk_lanes_f(sk_on1, z));
//   }                                                if (!native::any(sk_on1)) break;
//                                                    z = sk_lanes_g(sk_on1, z);       // who has left looks no more at it
//                                                    native::put(sk_on1, steps, steps + 1_i);
//                                                  }
#pragma once

#include <string>

#include "emit/divergence.hpp"
#include "emit/native_expr.hpp"

namespace skc::emit {

/// What a function is called in its form for lanes.
std::string lanesFunction(const NativeContext& context, ir::FunctionId id);
/// "native::Lanes<sk_real>", "native::Vec<native::Lanes<native::Int>, 2>".
std::string lanesType(const NativeContext& context, ir::Type type);

/// An expression, of which what is the same for all lanes is a scalar. `on` names the mask of the lanes that take part, and is
/// empty where all do.
std::string lanesExpr(const NativeContext& context, ir::FunctionId function, const ir::Expr& expr,
                      const std::string& on);
/// The same, as a value of lanes whatever it is.
std::string spreadExpr(const NativeContext& context, ir::FunctionId function, const ir::Expr& expr,
                       const std::string& on);

/// The form for lanes of a function that differs between them, indented by two spaces. `context` has the divergence.
std::string lanesFunctionText(const NativeContext& context, ir::FunctionId id);

}  // namespace skc::emit
