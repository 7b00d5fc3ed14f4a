// SPDX-License-Identifier: MIT
//
// Types of TypeScript for what a .sk file declares.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"

namespace skc::web {

/// What a module exports under one name: the overloads of a kernel or reduce.
struct Export {
  std::vector<std::string> scope;  ///< namespaces, which are objects in JavaScript
  std::string name;
  std::vector<std::size_t> units;  ///< indices into Program::units()
};
std::vector<Export> exportsOf(const ir::Module& module, const emit::Program& program);

/// The name of a struct's constant and interface: "geometry_Hit" for geometry::Hit.
std::string structName(const ir::Module& module, std::uint32_t index);

/// A name that JavaScript allows: `delete` becomes `delete_`.
std::string jsName(std::string_view name);

/// FILE.sk.d.ts.
std::string typings(const ir::Module& module, const emit::Program& program, std::string_view fileName);

}  // namespace skc::web
