// SPDX-License-Identifier: MIT
//
// How an element lies in host memory: its planes, each a scalar or vector, with the offsets that C++
// gives the members of the struct that the stub declares.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emit/type_names.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

struct Plane {
  std::string path;      ///< in GLSL: "origin.x"; empty where the element is no struct
  std::string member;    ///< in C++
  ir::Type type;
  std::uint32_t offset;
};

struct ElementLayout {
  std::vector<Plane> planes;
  std::uint32_t size = 0;
  std::uint32_t alignment = 1;
};

/// Of a scalar, a vector, or a struct of these and of such structs. bool takes a byte, the other
/// scalars 4; vectors are packed and aligned like their component.
ElementLayout elementLayout(const ir::Module& module, const TypeNames& types, ir::Type type);

}  // namespace skc::emit
