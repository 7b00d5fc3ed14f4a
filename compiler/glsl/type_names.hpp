// SPDX-License-Identifier: MIT
//
// Spells the types of a module in GLSL. Structs and their members have the same names in all kernels of the
// module, because they share descriptors of elements.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"
#include "support/namer.hpp"

namespace skc::emit {

class TypeNames {
 public:
  explicit TypeNames(const ir::Module& module);

  /// "vec3", "Hit", "float[5]".
  std::string glsl(ir::Type type) const;
  /// "vec3 name", "float name[5]".
  std::string declaration(ir::Type type, const std::string& name) const;
  const std::string& structName(std::uint32_t index) const { return structs_[index]; }
  const std::string& fieldName(std::uint32_t index, std::uint32_t field) const {
    return fields_[index][field];
  }

 private:
  const ir::Module* module_;
  std::vector<std::string> structs_;
  std::vector<std::vector<std::string>> fields_;
};

/// "float", "bvec2"; a narrow scalar's arithmetic type; "sk_double", "sk_double2" (doubles.hpp).
std::string glslSpelling(ir::Scalar scalar, int width);

}  // namespace skc::emit
