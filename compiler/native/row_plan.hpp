// SPDX-License-Identifier: MIT
//
// Register blocking by rows. Where a loop of a kernel reads elements that do not depend on the row, as a product of matrices
// does, code that computes several rows together reads them once for all of these:
//
//   for (k) sum += a[p.y][k] * b[k][p.x];      for (k) { bk = b[k][p.x]; sum0 += a[y][k] * bk; sum1 += a[y + 1][k] * bk; ... }
//
// Control flow that is the same in all rows is written once, and what depends on the row once for each row. All values
// are those of rows computed alone.
#pragma once

#include <cstdint>
#include <set>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"
#include "native/target.hpp"
#include "sk/native/code.hpp"

namespace skc::native {

/// What depends on the row in a kernel's entry. The module has been through `predicate`.
class RowPlan {
 public:
  RowPlan(const ir::Module& module, const ir::Kernel& kernel);

  /// True if computing rows together saves loads: a loop that all rows run through together reads vectors that they share.
  bool pays(const analysis::Uniformity& lanes) const;
  /// Scalars that each row carries from one iteration of such loops to the next.
  std::uint32_t carried() const;

  /// True of a variable of the entry that has a value of its own in each row.
  bool isPerRow(ir::VarId var) const { return perRow_.contains(var); }
  /// True of a statement that is written once for all rows; what it contains may still depend on the row.
  bool isJoint(const ir::Stmt& stmt) const;
  /// True of an expression of the entry that has one value for all rows.
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

/// Lanes of a row, and rows, that fill the registers of the CPU with what `carried` scalars are in all of them.
struct RowBlock {
  std::uint32_t lanes, rows;
};
RowBlock blockFor(const CpuLevel& level, std::uint32_t carried);

}  // namespace skc::native
