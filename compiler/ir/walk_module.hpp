// SPDX-License-Identifier: MIT
//
// Visits every type and every expression of a module, wherever one is stored. Transforms that renumber types,
// functions or constants use these functions, so that no reference keeps an old number. walk_module.cpp names
// all members of each declaration that holds any: a new member of such a struct does not compile until it is
// named there, too.
#pragma once

#include <cstddef>

#include "ir/ir.hpp"
#include "support/function_ref.hpp"

namespace skc::ir {

/// fn(expr) for every expression: in functions, constants and kernels' parameters.
void walkExprs(Module& module, FunctionRef<void(Expr&)> fn);

/// fn(type) for the type of every expression and declaration, except members of structs and elements of arrays.
void walkTypes(Module& module, FunctionRef<void(Type&)> fn);

/// fn(type) for the types of all members of structs and of all elements of arrays.
void walkTypesInTypes(Module& module, FunctionRef<void(Type&)> fn);

/// Calls visit(id) for each kernel that the module has now, and for none that `visit` adds. Adding kernels invalidates
/// references to others.
template <class Visit>
void forEachDeclaredKernel(const Module& module, const Visit& visit) {
  const std::size_t declared = module.kernels.size();
  for (KernelId id = 0; id < declared; ++id) visit(id);
}

}  // namespace skc::ir
