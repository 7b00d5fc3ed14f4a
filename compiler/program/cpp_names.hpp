// SPDX-License-Identifier: MIT
//
// Chooses names in the generated C++. Names from the .sk file are valid C++, since Clang has parsed them;
// what remains is to avoid global names of C++ headers and generated names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"

namespace skc::emit {

/// The kernels that one callable object stands for: the overloads of one name in one namespace.
struct Callable {
  std::vector<std::string> scope;
  std::string object;              ///< "diffuse"
  std::string type;                ///< "DiffuseKernel"
  std::vector<std::size_t> units;  ///< indices into Program::units()
};

/// The callables, in the order of their first kernels.
std::vector<Callable> callables(const ir::Module& module, const Program& program);

/// A unique prefix for the names of each unit's descriptors: "diffuse", "grayScott", "sum_2".
std::vector<std::string> descriptorNames(const ir::Module& module, const Program& program);

/// A unique prefix for each table of the module: "sk_response".
std::vector<std::string> tableNames(const ir::Module& module);

/// "gray_scott" gives "GrayScott": every other character than a letter or digit separates words.
std::string pascalCase(std::string_view name);

/// "float", "sk::float2", "geometry::Hit"; just "Hit" as seen from namespace geometry.
std::string cppType(const ir::Module& module, ir::Type type, const std::vector<std::string>& scope = {});

/// True for functions of the C library that its C++ headers declare in the global namespace.
bool isGlobalCName(std::string_view name);

}  // namespace skc::emit
