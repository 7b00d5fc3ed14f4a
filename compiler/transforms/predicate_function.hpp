// SPDX-License-Identifier: MIT
//
// Private to predicate: rewrites one function.
#pragma once

#include <set>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"
#include "transforms/blend_cost.hpp"

namespace skc {

/// Facts about a kernel's functions before any of them is rewritten.
struct PredicateContext {
  const ir::Module& module;
  const analysis::Uniformity& uniformity;
  std::set<ir::FunctionId> masked;  ///< functions that take a mask
  std::set<ir::FunctionId> isLong;  ///< see hoist_expressions.hpp
};

/// The rewritten function.
ir::Function predicated(const PredicateContext& context, BlendCost& cost, ir::FunctionId id);

}  // namespace skc
