// SPDX-License-Identifier: MIT
//
// Visits the kernels of a module while it gets more of them.
#pragma once

#include <cstddef>

#include "ir/ir.hpp"

namespace skc::ir {

/// Calls visit(id) for each kernel that the module has now, and for none that `visit` adds. Adding kernels invalidates
/// references to others.
template <class Visit>
void forEachDeclaredKernel(const Module& module, const Visit& visit) {
  const std::size_t declared = module.kernels.size();
  for (KernelId id = 0; id < declared; ++id) visit(id);
}

}  // namespace skc::ir
