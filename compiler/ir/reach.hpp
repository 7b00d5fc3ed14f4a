// SPDX-License-Identifier: MIT
//
// The call graph: who calls whom, and which functions a kernel needs.
#pragma once

#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc::ir {

/// The functions that a function calls, each once, in the order in which they are found.
std::vector<FunctionId> callees(const Function& function);

/// The functions that a kernel needs, each once, callees before their callers: its entry and all that this
/// reaches.
std::vector<FunctionId> functionsOf(const Module& module, const Kernel& kernel);

/// Those of them that a table may stand for.
std::vector<FunctionId> tabulatedFunctionsOf(const Module& module, const Kernel& kernel);

/// Whether a value of this type is a double or holds one.
bool holdsDouble(const Module& module, Type type);
/// Whether a kernel's parameters or functions have anything to do with doubles.
bool usesDoubles(const Module& module, const Kernel& kernel);

/// Whether a kernel computes what additions of floats lose.
bool usesExactSums(const Module& module, const Kernel& kernel);

/// Whether a kernel asks where an element is, or for the shape of an input, which a partial result has not:
/// the place of the first such expression or iterator. After specialize-gathers.
std::optional<Loc> usesPlace(const Module& module, const Kernel& kernel);

/// A function that reaches itself, if there is one.
std::optional<FunctionId> findRecursion(const Module& module);

}  // namespace skc::ir
