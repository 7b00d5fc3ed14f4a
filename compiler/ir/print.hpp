// SPDX-License-Identifier: MIT
//
// Prints the IR as text for --emit=ir and --print-after: C-like, complete, and deterministic. Nothing parses
// it.
#pragma once

#include <string>
#include <string_view>

#include "ir/ir.hpp"

namespace skc::ir {

std::string print(const Module& module);
std::string print(const Module& module, const Function& function);
std::string print(const Module& module, const Function& function, const Expr& expr);
/// "u", or "$0" for the kernel's first parameter, or "domain".
std::string print(const Function& function, StreamRef stream);
/// "float3", "geometry::Hit", "float[5]": as the .sk file writes it.
std::string print(const Module& module, Type type);

/// "+", "<<", "&&".
std::string_view spelling(BinaryOp op);
std::string_view spelling(UnaryOp op);
/// "float", "int3".
std::string spelling(Scalar scalar, int width = 1);
std::string_view spelling(VarRole role);
std::string_view spelling(ParamRole role);
std::string_view spelling(Boundary boundary);
/// "=", "+=", "min", "max".
std::string_view spelling(ScatterOp op);
/// "a::b::" for {"a", "b"}.
std::string qualifier(const std::vector<std::string>& scope);

/// The offsets between which a kernel reads a gather in each dimension, as "x -1 to 2, y 0, z whole". A bound that
/// depends on Spec parameters names them; a promise is mentioned.
std::string printReach(const Kernel& kernel, const KernelParam& param);

}  // namespace skc::ir
