// SPDX-License-Identifier: MIT
//
// Names what a module for browsers exports. Kernels and structs of a namespace become members of an object, or names that begin with
// the namespace's.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"
#include "support/diagnostics.hpp"

namespace skc::web {

/// A callable: the kernels of one name in one namespace.
struct Export {
  std::string name;  ///< of the constant, or of the member of the namespace's object
  std::vector<std::size_t> units;  ///< indices of its overloads in Program::units()
};

/// The callables of one namespace.
struct Scope {
  std::string name;  ///< of the object that has them; empty for the module itself
  std::vector<std::string> path;  ///< the namespaces, outermost first
  std::vector<Export> exports;  ///< in file order
};

class JsNames {
 public:
  explicit JsNames(const ir::Module& module);

  /// The scopes that have kernels; the module itself comes first.
  const std::vector<Scope>& scopes() const { return scopes_; }
  /// The name of a struct's constant and interface, for the structs that kernels use.
  const std::string& structName(std::uint32_t index) const { return structs_.at(index).name; }
  /// The name of the interface of arrays of its members.
  const std::string& arraysName(std::uint32_t index) const { return structs_.at(index).arrays; }

  /// The name of a bundle's interface.
  const std::string& bundleName(std::uint32_t index) const { return bundles_.at(index); }

 private:
  struct StructNames {
    std::string name, arrays;
  };

  std::vector<Scope> scopes_;
  std::map<std::uint32_t, StructNames> structs_;
  std::vector<std::string> bundles_;
};

/// A parameter's name in a list of types.
std::string jsParameterName(std::string_view name);

/// Reports which kernels and structs have another name in JavaScript.
void reportJsNames(const ir::Module& module, Diagnostics& diagnostics);

}  // namespace skc::web
