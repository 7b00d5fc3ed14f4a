// SPDX-License-Identifier: MIT
//
// The shape of an expression: how its values for neighbouring elements relate to each other, given the shapes
// of the variables. A value is a list of scalar leaves; a leaf has no shape until something is assigned to
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "ir/ir.hpp"

namespace skc::analysis {

/// X compares lanes, which are neighbours along x; Y compares elements of consecutive rows with the same x.
enum class Axis : std::uint8_t { X, Y };

enum class Shape : std::uint8_t {
  Uniform,  ///< one value for all elements
  Consecutive,  ///< an int along x: each lane has 1 more than the lane before
  Varying,  ///< anything else
};

/// nullopt is the bottom of the lattice, Varying its top; Uniform and Consecutive are between them.
using LeafShape = std::optional<Shape>;
using LeafShapes = std::vector<LeafShape>;

struct FunctionShapes {
  std::vector<LeafShapes> variables;
  LeafShapes result;
};
using KernelShapes = std::map<ir::FunctionId, FunctionShapes>;

/// The number of leaves of a type: one per scalar; an array counts as a single element.
std::size_t leafCount(const ir::Module& module, ir::Type type);
/// The index of a field's first leaf in its struct.
std::size_t firstLeaf(const ir::Module& module, ir::Type type, std::uint32_t field);
/// The value of an index that is a literal below `length`.
std::optional<std::uint32_t> literalIndex(const ir::Expr& index, std::uint32_t length);

/// The shape of a value that is either of the two.
LeafShape join(LeafShape a, LeafShape b);
LeafShape join(const LeafShapes& leaves);
inline bool isVarying(LeafShape leaf) { return leaf && *leaf != Shape::Uniform; }

class ExprShapes {
 public:
  ExprShapes(const ir::Module& module, const ir::Kernel& kernel, const KernelShapes& shapes, Axis axis)
      : module_(module), kernel_(kernel), shapes_(shapes), axis_(axis) {}

  LeafShapes of(ir::FunctionId function, const ir::Expr& expr) const;
  /// The leaves of the value that `place op= value` assigns.
  LeafShapes ofCompound(ir::FunctionId function, const ir::Expr& place, ir::BinaryOp op,
                        const ir::Expr& value) const;
  /// The leaves that an assignment to `place` gives to its root variable; nullopt for all others.
  LeafShapes assigned(ir::FunctionId function, const ir::Expr& place, LeafShapes value) const;

 private:
  friend class ExprRule;

  const ir::Module& module_;
  const ir::Kernel& kernel_;
  const KernelShapes& shapes_;
  Axis axis_;
};

}  // namespace skc::analysis
