// SPDX-License-Identifier: MIT
//
// How the indices of gathers change from one iteration of a loop to the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "analysis/uniformity.hpp"
#include "ir/ir.hpp"

namespace skc::native {

/// The largest body of a loop that is emitted twice.
inline constexpr std::uint32_t mostExpressionsOfBody = 100;

/// The integers of a loop whose step adds one to a uniform counter, which its body does not assign.
class LoopIndices {
 public:
  /// Returns nullopt for any other loop. The module and the loop must outlive the result.
  static std::optional<LoopIndices> of(const ir::Module& module, const analysis::Uniformity& uniformity,
                                       ir::FunctionId function, const ir::Loop& loop);

  ir::VarId counter() const { return counter_; }
  /// A copy that can be computed before the body runs: variables that the body declares and never reassigns are replaced by
  /// their initial values.
  ir::ExprPtr beforeBody(const ir::Expr& expr);
  /// True if an expression has the same value in all iterations.
  bool isInvariant(const ir::Expr& expr) const;
  /// True if an integer grows by one in each iteration: it is the counter, plus or minus invariant values.
  bool growsByOne(const ir::Expr& expr) const;

 private:
  LoopIndices(const ir::Module& module, const ir::Loop& loop, ir::VarId counter);

  const ir::Module* module_;
  const ir::Loop* loop_;
  ir::VarId counter_;
  std::map<ir::VarId, const ir::Expr*> declared_;  ///< variables of the body; initial values or null
  std::size_t replaced_ = 0;
};

/// True if a loop's body is small enough to be emitted twice, and has no inner loop.
bool isBodySmall(const ir::Module& module, const ir::Loop& loop);

}  // namespace skc::native
