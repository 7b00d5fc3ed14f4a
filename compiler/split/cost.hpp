// SPDX-License-Identifier: MIT
//
// What a slice costs an element, as a number to compare alternatives by. The unit is one operation on
// one component. A component read from memory or written to it counts as much as 32 of them: between
// what llvmpipe (4 operations a byte) and a GPU (12) give. It is a model: docs/architecture.md,
// "Kernels in several passes", has its rows.
#pragma once

#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

/// Of reading, or writing, one component of 4 bytes.
inline constexpr double componentCost = 32;
/// Of one more pass: its fixed cost, spread over the elements of a stream of some size.
inline constexpr double passCost = 64;

/// Scalars and vectors that an element consists of: what one texel each holds.
std::vector<ir::Type> planesOf(const ir::Module& module, ir::Type type);
/// Of reading or writing one of these.
double planeCost(ir::Type plane);
/// Of reading or writing a whole element.
double elementCost(const ir::Module& module, ir::Type type);

class CostModel {
 public:
  explicit CostModel(const ir::Module& module);

  /// Of running the statements that a slice of this body keeps: arithmetic and gathers, not what is
  /// read and written for the parameters.
  double run(const ir::Block& body, const Slice& slice) const;

 private:
  double block(const ir::Block& body, const Slice* slice) const;
  double statement(const ir::Stmt& stmt, const Slice* slice) const;
  double expression(const ir::Expr& expr) const;

  const ir::Module& module_;
  std::vector<double> functions_;   ///< of one call
};

}  // namespace skc::split
