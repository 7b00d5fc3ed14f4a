// SPDX-License-Identifier: MIT
//
// The call graph: who calls whom, and which functions a kernel reaches.
#pragma once

#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc::ir {

/// The functions that a function calls, each once, in the order of their first call.
std::vector<FunctionId> callees(const Function& function);

/// The functions that a kernel reaches, including its entry, each once, callees before callers.
std::vector<FunctionId> functionsOf(const Module& module, const Kernel& kernel);

/// The functions that a kernel reaches and a table may replace.
std::vector<FunctionId> tabulatedFunctionsOf(const Module& module, const Kernel& kernel);

/// True if the type is a double or contains one.
bool holdsDouble(const Module& module, Type type);
/// True if a kernel's parameters or functions use doubles.
bool usesDoubles(const Module& module, const Kernel& kernel);
/// Likewise for integers of 64 bits.
bool usesLongs(const Module& module, const Kernel& kernel);

/// True if a kernel computes rounding errors of float additions.
bool usesExactSums(const Module& module, const Kernel& kernel);

/// The source location of the first expression or iterator that asks for an element's index or an input's
/// shape, which a partial result does not have. After specialize-gathers.
std::optional<Loc> usesIndex(const Module& module, const Kernel& kernel);

/// A function that calls itself, directly or indirectly, if there is one.
std::optional<FunctionId> findRecursion(const Module& module);

}  // namespace skc::ir
