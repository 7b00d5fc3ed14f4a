// SPDX-License-Identifier: MIT
//
// How the values of elements that are computed together relate to each other, and where their control flow diverges. Along x,
// the elements are lanes: neighbours in one row of the domain. Along y, they are in consecutive rows. Every value starts as uniform, and what makes it
// vary is propagated to a fixed point (R. Karrenberg and S. Hack, "Whole-function vectorization", 2011).
//
// Values count for the active lanes only: in a loop that lanes leave at different times, a counter is uniform for as long as
// no lane that has left can read it.
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
  /// After specialize-gathers.
  Uniformity(const ir::Module& module, const ir::Kernel& kernel, Axis axis = Axis::X);

  // A function is one that the kernel reaches. A value has a shape for each scalar leaf: 1 for a scalar, one a component
  // for a vector, width * width for a matrix, row by row, those of the fields in order for a struct; and for an array those of one
  // element, since all elements share them.
  std::span<const Shape> of(ir::FunctionId function, ir::VarId var) const;
  std::span<const Shape> resultOf(ir::FunctionId function) const;
  std::vector<Shape> leavesOf(ir::FunctionId function, const ir::Expr& expr) const;
  /// The shape of all leaves together: Uniform where all are, Consecutive of a scalar only.
  Shape of(ir::FunctionId function, const ir::Expr& expr) const;

  /// True if control flow diverges here: an If, Loop or Switch that has to run under a mask, or a jump that not every
  /// active lane takes with the others.
  bool diverges(ir::FunctionId function, const ir::Stmt& stmt) const;
  /// True if some lanes skip the rest of a round of this loop.
  bool skips(ir::FunctionId function, const ir::Stmt& loop) const;
  /// True if lanes that are not active could see what the statement assigns to the variable, so that their value has to stay.
  bool blends(ir::FunctionId function, const ir::Stmt& stmt, ir::VarId var) const;
  /// True if some lanes return from the function before others.
  bool returnsEarly(ir::FunctionId function) const { return at(function).returnsEarly; }
  /// True if a call of the function may have inactive lanes, apart from those that the caller is called with.
  bool isCalledDivergently(ir::FunctionId function) const { return at(function).isCalledDivergently; }

 private:
  friend class DivergenceWalk;

  /// What is known of a function.
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
