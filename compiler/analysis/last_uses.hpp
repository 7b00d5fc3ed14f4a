// SPDX-License-Identifier: MIT
//
// Finds the last use of each variable of a function and the end of each loop, in source order.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "ir/ir.hpp"

namespace skc::analysis {

class LastUses {
 public:
  explicit LastUses(const ir::Function& function);

  /// True if the variable is used after the end of the loop.
  bool isUsedAfter(ir::VarId var, const ir::Stmt& loop) const { return lastUse_[var] > ends_.at(&loop); }

 private:
  void visit(const ir::Block& block);
  void use(const ir::Expr& expr);

  std::vector<std::size_t> lastUse_;
  std::map<const ir::Stmt*, std::size_t> ends_;
  std::size_t now_ = 0;  ///< number of statements visited
};

}  // namespace skc::analysis
