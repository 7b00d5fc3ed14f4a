// SPDX-License-Identifier: MIT
//
// Chooses the names in one kernel's GLSL body. Names from the .sk file stay wherever GLSL allows them; no
// other code renames anything.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "glsl/type_names.hpp"
#include "ir/ir.hpp"

namespace skc::emit {

class KernelNames {
 public:
  KernelNames(const ir::Module& module, const ir::Kernel& kernel, const TypeNames& types);

  const std::string& function(ir::FunctionId id) const { return functions_.at(id).name; }
  const std::string& variable(ir::FunctionId id, ir::VarId var) const {
    return functions_.at(id).variables[var];
  }
  /// program::Parameter::symbol, which also names the entry's variable.
  const std::string& symbol(std::uint32_t param) const { return variable(entry_, param); }

 private:
  struct FunctionNames {
    std::string name;
    std::vector<std::string> variables;
  };

  ir::FunctionId entry_;
  std::map<ir::FunctionId, FunctionNames> functions_;
};

}  // namespace skc::emit
