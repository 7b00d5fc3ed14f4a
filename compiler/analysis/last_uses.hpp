// SPDX-License-Identifier: MIT
//
// Where in its function each variable is named for the last time, and where each loop ends, in the order of the text.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "ir/ir.hpp"

namespace skc::analysis {

class LastUses {
 public:
  explicit LastUses(const ir::Function& function);

  /// Whether the variable is named after the end of the loop.
  bool isUsedAfter(ir::VarId var, const ir::Stmt& loop) const { return lastUse_[var] > ends_.at(&loop); }

 private:
  void visit(const ir::Block& block);
  void use(const ir::Expr& expr);

  std::vector<std::size_t> lastUse_;
  std::map<const ir::Stmt*, std::size_t> ends_;
  std::size_t now_ = 0;  ///< statements so far
};

}  // namespace skc::analysis
