// SPDX-License-Identifier: MIT
//
// Register blocking by rows. If a loop of a kernel reads elements that do not depend on the row, as in a
// product of matrices, code that computes several rows together reads them once:
//
//   for (k) sum += a[p.y][k] * b[k][p.x];      for (k) { bk = b[k][p.x]; sum0 += a[y][k] * bk; sum1 += a[y + 1][k] * bk; ... }
//
// Control flow that is uniform along y is emitted once, and what depends on the row once per row. All values
// are the same as when rows are computed one by one.
#pragma once

#include <cstdint>
#include <set>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"
#include "native/target.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

/// Finds what depends on the row in a kernel's entry. The module must have passed `predicate`.
class RowPlan {
 public:
  RowPlan(const ir::Module& module, const ir::Kernel& kernel);

  /// The gathers of which a loop that all rows run through together reads vectors that they share. Computing
  /// rows together saves loads if there is one.
  std::set<std::uint32_t> sharedGathers(const analysis::Uniformity& lanes) const;
  /// The number of words of 32 bits that each row carries from one iteration of such loops to the next.
  std::uint32_t carried() const;

  /// True if a variable of the entry has its own value in each row.
  bool isPerRow(ir::VarId var) const { return perRow_.contains(var); }
  /// True if a statement is emitted once for all rows; statements in it may still depend on the row.
  bool isEmittedOnce(const ir::Stmt& stmt) const;
  /// True if an expression of the entry has the same value in all rows.
  bool isShared(const ir::Expr& expr) const;

 private:
  void addAssigned(const ir::Block& body, bool isDivergent);
  void addAssignedBy(const ir::Stmt& stmt);

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  const ir::Function& entry_;
  analysis::Uniformity rows_;
  std::set<ir::VarId> perRow_;
};

/// The lanes and the rows that code computes together.
struct RowBlock {
  std::uint32_t lanes, rows;
};

/// The block whose `carried` words, in all lanes and rows, fill the registers of the CPU.
RowBlock blockFor(const CpuLevel& level, std::uint32_t carried);

}  // namespace skc::native
