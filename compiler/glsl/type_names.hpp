// SPDX-License-Identifier: MIT
//
// How the types of a module are spelled in GLSL. Structs and their members have one name in all
// kernels of the module, because descriptors of elements are shared.
#pragma once

#include <string>
#include <vector>

#include "ir/ir.hpp"

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

/// "float", "bvec2"; of a narrow scalar those of its carrier; "sk_double", "sk_double2" (doubles.hpp).
std::string glslSpelling(ir::Scalar scalar, int width);

/// `base`, or the first of base_2, base_3 ... that `isTaken` lets through.
template <class Predicate>
std::string uniqueName(const std::string& base, Predicate&& isTaken) {
  std::string name = base;
  for (int i = 2; isTaken(name); ++i) name = base + (base.back() == '_' ? "" : "_") + std::to_string(i);
  return name;
}

}  // namespace skc::emit
