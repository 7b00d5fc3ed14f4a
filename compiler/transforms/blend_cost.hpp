// SPDX-License-Identifier: MIT
//
// Private to predicate: estimates whether statements are so short that executing them under an empty mask
// costs less than testing whether any lane is active.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "ir/ir.hpp"

namespace skc {

class BlendCost {
 public:
  explicit BlendCost(const ir::Module& module) : module_(module) {}

  bool isShort(std::span<const ir::Stmt> statements) { return of(statements) < limit; }

 private:
  /// Roughly the operations that a mispredicted branch costs.
  static constexpr std::uint32_t limit = 12;
  /// Relative to an addition. Most intrinsics are a few operations; a gather is one per lane.
  static constexpr std::uint32_t intrinsicCost = 4, gatherCost = limit;

  std::uint32_t of(std::span<const ir::Stmt> statements);
  std::uint32_t of(const ir::Stmt& stmt);
  std::uint32_t of(const ir::Expr& expr);
  std::uint32_t ofCall(ir::FunctionId callee);

  const ir::Module& module_;
  std::map<ir::FunctionId, std::uint32_t> calls_;
};

}  // namespace skc
