// SPDX-License-Identifier: MIT
//
// References of one call that name parts of one object. Devices pass copies, which would not see each other's
// changes; so such a call has a version of its function that takes the whole object once, and names its parts.
//
//   v.add(v)             ->   add_1(v)            where add_1 reads v for the parameter, too
//   order(a[i], a[j])    ->   order_1(a, {i, j})  where order_1 reads and writes a[indices.x] and a[indices.y]
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ir/ir.hpp"

namespace skc::frontend {

/// One step from the whole object towards a part: a member, the element at a literal index, or the element at one
/// of the indices that the call passes.
struct AliasStep {
  enum class Kind : std::uint8_t { Field, Element, Index };
  Kind kind;
  std::uint32_t value;
};

/// Which part of an object a parameter names.
struct Alias {
  std::uint32_t whole;  ///< the parameter that receives the object
  std::uint32_t indices;  ///< the parameter that receives the indices
  std::vector<AliasStep> steps;
};

/// The parameters of one version of a function that are parts of objects.
struct Aliases {
  std::map<std::uint32_t, Alias> parts;  ///< by parameter
  std::map<std::uint32_t, ir::Type> wholes;  ///< by parameter: the type of the object
  std::map<std::uint32_t, ir::Type> indices;  ///< by parameter: the type of the indices that it receives

  bool empty() const { return parts.empty(); }
  /// Differs for any two versions of one function.
  std::string key() const;
};

/// The steps of an lvalue, from its variable outwards.
std::vector<const ir::Expr*> chainOf(const ir::Expr& lvalue);

/// The number of steps that all chains begin with.
std::size_t commonSteps(const std::vector<std::vector<const ir::Expr*>>& chains);

}  // namespace skc::frontend
