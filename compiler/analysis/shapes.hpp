// SPDX-License-Identifier: MIT
//
// How the values that neighbouring elements have of an expression relate to each other, given those of the variables. A value
// is a list of scalar leaves, each with a shape, or without one as long as nothing is known to be assigned to it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc::analysis {

/// Which elements are compared: the lanes, which are neighbours along x; or elements of consecutive rows, which have the same x.
enum class Axis : std::uint8_t { X, Y };

enum class Shape : std::uint8_t {
  Uniform,  ///< one value for all elements
  Consecutive,  ///< an int along x; each lane has 1 more than the lane before
  Varying,  ///< anything else
};

/// None is the bottom of the lattice; Uniform and Consecutive are above it, and Varying is the top.
using Leaf = std::optional<Shape>;
using Leaves = std::vector<Leaf>;

struct FunctionShapes {
  std::vector<Leaves> variables;
  Leaves result;
};
using KernelShapes = std::map<ir::FunctionId, FunctionShapes>;

/// How many leaves a value of this type has: one for each scalar, and those of a single element for an array.
std::size_t leafCount(const ir::Module& module, ir::Type type);

/// The shape of something that is one of the two.
Leaf join(Leaf a, Leaf b);
Leaf join(const Leaves& leaves);
inline bool isVarying(Leaf leaf) { return leaf && *leaf != Shape::Uniform; }

class ExprShapes {
 public:
  ExprShapes(const ir::Module& module, const ir::Kernel& kernel, const KernelShapes& shapes, Axis axis)
      : module_(module), kernel_(kernel), shapes_(shapes), axis_(axis) {}

  Leaves of(ir::FunctionId function, const ir::Expr& expr) const;
  /// What `place op= value` assigns.
  Leaves ofCompound(ir::FunctionId function, const ir::Expr& place, ir::BinaryOp op,
                    const ir::Expr& value) const;
  /// The leaves of the variable at the root of a place after an assignment of these, with none where it leaves them alone.
  Leaves assigned(ir::FunctionId function, const ir::Expr& place, Leaves value) const;

 private:
  friend class ExprRule;

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  const KernelShapes& shapes_;
  Axis axis_;
};

}  // namespace skc::analysis
