// SPDX-License-Identifier: MIT
//
// Spells the types and constants of a module in GLSL. Structs and their members have the same names in all kernels of the
// module, because they share descriptors of elements; constants have, so that they are named only once.
#pragma once

#include <set>
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
  bool isStructName(const std::string& name) const { return structNames_.contains(name); }

  const std::string& constantName(ir::ConstantId id) const { return constants_[id]; }
  bool isConstantName(const std::string& name) const { return constantNames_.contains(name); }
  /// The text of a use of a constant: its name, or a call if it must be a function (constants.hpp).
  const std::string& constantUse(ir::ConstantId id) const { return constantUses_[id]; }

 private:
  const ir::Module* module_;
  std::vector<std::string> structs_;
  std::vector<std::vector<std::string>> fields_;
  std::vector<std::string> constants_, constantUses_;
  std::set<std::string> structNames_, constantNames_;
};

/// "float", "bvec2"; a narrow scalar's arithmetic type; "sk_double", "sk_long2" (wide_values.hpp).
std::string glslSpelling(ir::Scalar scalar, int width);
/// The same for a scalar or a vector.
std::string glslSpelling(ir::Type type);

}  // namespace skc::emit
