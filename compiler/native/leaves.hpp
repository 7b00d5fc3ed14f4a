// SPDX-License-Identifier: MIT
//
// The scalars that a value of the IR is made of. A leaf is one of them, where the elements of an array share theirs; a
// component is one of them, where each element of an array has its own. Components are in the order in which streams have
// arrays for them: that of the declaration.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"

namespace skc::native {

struct Leaf {
  ir::Scalar scalar;
  std::vector<std::uint32_t> dimensions;  ///< lengths of the arrays around it, outermost first

  std::uint32_t count() const;  ///< of its components
};

struct Component {
  std::uint32_t leaf;
  std::uint32_t offset;  ///< among the components of that leaf
};

std::vector<Leaf> leavesOf(const ir::Module& module, ir::Type type);
std::vector<Component> componentsOf(const ir::Module& module, ir::Type type);

/// The scalar of each component.
std::vector<ir::Scalar> scalarsOf(const ir::Module& module, ir::Type type);

/// How many leaves, or components, come before a member of a struct.
std::uint32_t leavesBefore(const ir::Module& module, ir::Type type, std::uint32_t field);
std::uint32_t componentsBefore(const ir::Module& module, ir::Type type, std::uint32_t field);
std::uint32_t componentCount(const ir::Module& module, ir::Type type);

}  // namespace skc::native
