// SPDX-License-Identifier: MIT
//
// What differs between neighbours along x that are computed side by side, each in a lane: which values, and where only some
// of the lanes go on. All else is computed once for them all. From the lowest upwards: a value is the same for all lanes until
// something is found that makes it differ (as in R. Karrenberg and S. Hack, "Whole-function vectorization", 2011).
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <vector>

#include "ir/ir.hpp"

namespace skc::emit {

struct FunctionDivergence {
  std::vector<bool> variables;  ///< those that differ
  bool result = false;  ///< differs
  bool isCalledApart = false;  ///< where some lanes may wait
  bool returnsApart = false;  ///< some lanes before others

  /// Whether it is needed for lanes; else it is computed once, as it is.
  bool differs() const;
};

class Divergence {
 public:
  Divergence(const ir::Module& module, const ir::Kernel& kernel);

  const FunctionDivergence& of(ir::FunctionId function) const { return functions_.at(function); }
  bool differs(ir::FunctionId function, ir::VarId var) const { return of(function).variables[var]; }
  bool differs(ir::FunctionId function, const ir::Expr& expr) const;

  /// An If or a Loop where lanes part; a Break, Continue or Return that not all of those take that began with the loop or function.
  bool isApart(const ir::Stmt& stmt) const { return apart_.contains(&stmt); }
  /// A loop of whose round some lanes skip the rest.
  bool skipsApart(const ir::Stmt& loop) const { return skipped_.contains(&loop); }
  /// An assignment that waiting lanes must not see.
  bool isBlended(const ir::Stmt& stmt) const { return blended_.contains(&stmt); }

  /// Whether a variable is the element's index, or components of it, and stays that: all but x is the same for all lanes.
  bool isIndex(ir::FunctionId function, ir::VarId var) const;
  /// Whether each lane's int is greater by 1 than that of the lane before: x of the element's index, and what is the same for all
  /// lanes more or less.
  bool isRamp(ir::FunctionId function, const ir::Expr& expr) const;
  bool isRamp(ir::FunctionId function, ir::VarId var) const;
  /// Whether a number differs only since lanes have left a loop at different times: for those in it, all reads there give the same.
  bool isInStep(ir::FunctionId function, ir::VarId var) const;

 private:
  friend class DivergenceWalk;

  bool isFirstComponent(ir::FunctionId function, const ir::Expr& vector, std::uint8_t component) const;

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  std::map<ir::FunctionId, FunctionDivergence> functions_;
  std::map<ir::FunctionId, std::map<ir::VarId, std::vector<std::uint8_t>>> indices_;  ///< components
  std::map<ir::FunctionId, std::map<ir::VarId, const ir::Expr*>>
      constant_;  ///< variables that stay what they are declared to be
  /// Of numbers in step: the loop, and what reads them there. Those that were found to differ in their loop, too.
  struct InStep {
    const ir::Stmt* loop;
    std::set<const ir::Expr*> reads;
  };
  std::map<ir::FunctionId, std::map<ir::VarId, InStep>> inStep_;
  std::map<ir::FunctionId, std::set<ir::VarId>> outOfStep_;
  std::set<const ir::Stmt*> apart_, skipped_, blended_;
};

}  // namespace skc::emit
