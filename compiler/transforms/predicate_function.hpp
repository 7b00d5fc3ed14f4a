// SPDX-License-Identifier: MIT
//
// Private to predicate: rewrites one function.
#pragma once

#include <set>
#include <span>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"

namespace skc {

/// Facts about a kernel's functions before any of them is rewritten.
struct PredicateContext {
  const ir::Module& module;
  const analysis::Uniformity& uniformity;
  std::set<ir::FunctionId> masked;  ///< functions that take a mask
  std::set<ir::FunctionId> isLong;  ///< see hoist_expressions.hpp
};

/// True if executing the statements under an empty mask costs less than testing whether any lane is active.
bool isShort(const ir::Module& module, std::span<const ir::Stmt> statements);

/// The rewritten function.
ir::Function predicated(const PredicateContext& context, ir::FunctionId id);

}  // namespace skc
