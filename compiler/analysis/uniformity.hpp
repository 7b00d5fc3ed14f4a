// SPDX-License-Identifier: MIT
//
// Finds how the values of elements that are computed together relate to each other, and where their control
// flow diverges. Along x, the elements are lanes: neighbours in one row of the domain. Along y, they are in
// consecutive rows. Every value starts as uniform; what makes it vary is propagated to a fixed point (R.
// Karrenberg and S. Hack, "Whole-function vectorization", 2011).
//
// Shapes hold for active lanes only: in a loop that lanes leave at different times, a counter is uniform as
// long as no lane that has left can read it.
#pragma once

#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "analysis/shapes.hpp"
#include "ir/ir.hpp"

namespace skc::analysis {

class Uniformity {
 public:
  /// The module must have passed specialize-gathers.
  Uniformity(const ir::Module& module, const ir::Kernel& kernel, Axis axis = Axis::X);

  // `function` must be reachable from the kernel. A value has one shape per scalar leaf: one for a scalar,
  // one per component of a vector, width * width row by row for a matrix, those of its fields in order for a
  // struct. All elements of an array share the shapes of one.
  std::span<const Shape> of(ir::FunctionId function, ir::VarId var) const;
  std::span<const Shape> resultOf(ir::FunctionId function) const;
  std::vector<Shape> leavesOf(ir::FunctionId function, const ir::Expr& expr) const;
  /// The shape of all leaves together: Uniform if all are uniform; Consecutive only for a scalar.
  Shape of(ir::FunctionId function, const ir::Expr& expr) const;

  /// True if control flow diverges here: an If, Loop or Switch that must run under a mask, or a jump that not
  /// every active lane takes.
  bool diverges(ir::FunctionId function, const ir::Stmt& stmt) const;
  /// True if some lanes skip the rest of an iteration of this loop.
  bool skips(ir::FunctionId function, const ir::Stmt& loop) const;
  /// True if inactive lanes may read the variable that the statement assigns: it needs a masked store.
  bool blends(ir::FunctionId function, const ir::Stmt& stmt, ir::VarId var) const;
  /// True if some lanes return from the function before others.
  bool returnsEarly(ir::FunctionId function) const { return at(function).returnsEarly; }
  /// True if a call may run with lanes inactive that are active at the start of the calling function.
  bool isCalledDivergently(ir::FunctionId function) const { return at(function).isCalledDivergently; }

 private:
  friend class DivergenceWalk;

  /// Facts about one function.
  struct Facts {
    std::vector<std::vector<Shape>> variables;
    std::vector<Shape> result;
    std::set<const ir::Stmt*> divergent, skipping;
    std::set<std::pair<const ir::Stmt*, ir::VarId>> blended;
    bool returnsEarly = false;
    bool isCalledDivergently = false;
  };
  const Facts& at(ir::FunctionId function) const { return facts_.at(function); }
  void propagate(const std::vector<ir::FunctionId>& functions);

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  Axis axis_;
  KernelShapes shapes_;
  std::map<ir::FunctionId, Facts> facts_;
};

}  // namespace skc::analysis
