// SPDX-License-Identifier: MIT
//
// The scalars that make up a value of the IR. A component is one of them; a leaf is one scalar of the type,
// shared by all elements of the arrays around it. Components are in the order of the declaration, as are the
// arrays of a stream.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/ir.hpp"

namespace skc::native {

struct Leaf {
  ir::Scalar scalar;
  std::vector<std::uint32_t> dimensions;  ///< lengths of the arrays around it, outermost first

  std::uint32_t count() const;  ///< number of its components
};

struct Component {
  std::uint32_t leaf;
  std::uint32_t offset;  ///< among the components of its leaf
};

std::vector<Leaf> leavesOf(const ir::Module& module, ir::Type type);
std::vector<Component> componentsOf(const ir::Module& module, ir::Type type);

/// The scalar of each component.
std::vector<ir::Scalar> scalarsOf(const ir::Module& module, ir::Type type);

/// The number of leaves, or components, before a member of a struct.
std::uint32_t leavesBefore(const ir::Module& module, ir::Type type, std::uint32_t field);
std::uint32_t componentsBefore(const ir::Module& module, ir::Type type, std::uint32_t field);
std::uint32_t componentCount(const ir::Module& module, ir::Type type);

}  // namespace skc::native
