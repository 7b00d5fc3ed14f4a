// SPDX-License-Identifier: MIT
//
// The cost model by which alternative slices are compared, per element. The unit is one operation on one
// component. Reading or writing a component in memory costs as much as 32 operations: between the figures of
// llvmpipe (4 operations a byte) and of a GPU (12). docs/architecture.md, "Kernels in several passes",
// tabulates the model.
//
// The same operations, counted once wherever they are written, are a kernel's weight, which says how long drivers take to
// compile it.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "ir/ir.hpp"
#include "split/slice.hpp"

namespace skc::split {

/// Cost of reading or writing one component of 4 bytes.
inline constexpr double componentCost = 32;
/// Cost of one more pass: its fixed cost, spread over the elements of a typical stream.
inline constexpr double passCost = 64;

/// The scalars and vectors that an element consists of; each takes one texel.
std::vector<ir::Type> planesOf(const ir::Module& module, ir::Type type);
/// Cost of reading or writing one plane.
double planeCost(ir::Type plane);
/// Cost of reading or writing a whole element.
double elementCost(const ir::Module& module, ir::Type type);

/// The weight of a kernel's body: the statements and expressions of its functions, each function once, where an operation on
/// doubles counts as much as it costs, and a call as much as the function, if the program has to define that.
std::uint32_t weightOf(const ir::Module& module, const ir::Kernel& kernel);

class CostModel {
 public:
  CostModel(const ir::Module& module, const ir::Kernel& kernel);

  /// Cost of running the statements in a slice of this body: arithmetic and gathers, without the reads and
  /// writes of parameters.
  double run(const ir::Block& body, const Slice& slice) const;

 private:
  double block(const ir::Block& body, const Slice* slice) const;
  double statement(const ir::Stmt& stmt, const Slice* slice) const;
  double expression(const ir::Expr& expr) const;
  /// The cost of a statement's own expressions.
  double operands(const ir::Stmt& stmt) const;

  const ir::Module& module_;
  std::unordered_map<ir::FunctionId, double>
      functions_;   ///< cost of one call of each function that the kernel needs
  std::unordered_map<const ir::Stmt*, double> operands_;   ///< of the statements of the kernel's entry
};

}  // namespace skc::split
