// SPDX-License-Identifier: MIT
//
// The layout of an element in host memory: its planes, each a scalar, a vector or a row of a matrix, at the
// offsets of the members of the C++ struct that the stub declares.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "glsl/type_names.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

struct Plane {
  std::string path;  ///< in GLSL: "origin.x"; empty if the element is not a struct
  std::string member;  ///< in C++
  ir::Type type;
  std::uint32_t offset;
  int part = -1;  ///< sk::program::Field::part
};

struct ElementLayout {
  std::vector<Plane> planes;
  std::uint32_t size = 0;
  std::uint32_t alignment = 1;
};

/// The layout of a scalar, a vector, a matrix, or a struct of these, possibly nested. Vectors and rows of
/// matrices are packed, and aligned like their component.
ElementLayout elementLayout(const ir::Module& module, const TypeNames& types, ir::Type type);

/// The offset in bytes of a member that is one plane.
std::uint32_t offsetOf(const ir::Module& module, const TypeNames& types, ir::Type type,
                       std::span<const std::uint32_t> members);

}  // namespace skc::emit
