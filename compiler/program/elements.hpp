// SPDX-License-Identifier: MIT
//
// How an element lies in host memory: its planes, each a scalar, a vector or a row of a matrix, with the offsets that C++
// gives the members of the struct that the stub declares.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "glsl/type_names.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

struct Plane {
  std::string path;  ///< in GLSL: "origin.x"; empty where the element is no struct
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

/// Of a scalar, a vector, a matrix, or a struct of these and of such structs. Vectors are packed and
/// aligned like their component, rows of matrices likewise.
ElementLayout elementLayout(const ir::Module& module, const TypeNames& types, ir::Type type);

/// Bytes from an element's start to a member of it that is one plane.
std::uint32_t offsetOf(const ir::Module& module, const TypeNames& types, ir::Type type,
                       std::span<const std::uint32_t> members);

}  // namespace skc::emit
