// SPDX-License-Identifier: MIT
//
// Private to predicate: rewrites one function.
#pragma once

#include <set>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"
#include "transforms/blend_cost.hpp"

namespace skc {

/// What is known of the functions of a kernel before any of them is rewritten.
struct PredicateContext {
  const ir::Module& module;
  const analysis::Uniformity& uniformity;
  std::set<ir::FunctionId> masked;  ///< those that take a mask
  std::set<ir::FunctionId> isLong;  ///< see hoist_calls.hpp
};

/// The function in its new form.
ir::Function predicated(const PredicateContext& context, BlendCost& cost, ir::FunctionId id);

}  // namespace skc
