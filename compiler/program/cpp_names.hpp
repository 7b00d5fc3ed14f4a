// SPDX-License-Identifier: MIT
//
// Chooses names in the generated C++. Names from the .sk file are valid C++, since Clang has parsed them;
// what remains is to avoid names of C++ headers and generated names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"
#include "support/diagnostics.hpp"

namespace skc::emit {

/// The kernels and pipelines that one callable object stands for: the overloads of one name in one namespace.
struct Callable {
  std::vector<std::string> scope;
  std::string object;  ///< "diffuse"
  std::string type;  ///< "DiffuseKernel"
  std::vector<std::size_t> units;  ///< indices into Program::units(), whose kernels these are
  std::vector<std::size_t> pipelines = {};  ///< indices into Module::pipelines, of those that are no kernels
};

/// Its overloads: the kernels of its units, and the faces of its pipelines.
std::vector<const ir::Kernel*> overloadsOf(const ir::Module& module, const Callable& callable);

/// The callables, in the order of their first kernels. Objects keep the names of their kernels wherever C++ allows it; their types
/// give way.
std::vector<Callable> callables(const ir::Module& module);

/// "gray_scott" gives "GrayScott": every other character than a letter or digit separates words.
std::string pascalCase(std::string_view name);
/// "grayScott".
std::string camelCase(std::string_view name);

/// "float", "sk::float2", "geometry::Hit"; just "Hit" as seen from namespace geometry.
std::string cppType(const ir::Module& module, ir::Type type, const std::vector<std::string>& scope = {});

/// The name of a struct or of a bundle in its namespace, and a parameter's in its function: with an underscore at the end if C++ does not allow the
/// user's.
std::string cppName(const ir::Module& module, const ir::Struct& type);
std::string cppName(const ir::Module& module, const ir::BundleType& bundle);
std::string cppName(const ir::Kernel& kernel, const ir::KernelParam& param);
/// The struct of a bundle: "geometry::Scene"; just "Scene" as seen from namespace geometry.
std::string cppType(const ir::Module& module, const ir::BundleType& bundle,
                    const std::vector<std::string>& scope = {});

/// Reports which kernels and structs have another name in C++, and which names C++ programs cannot write.
void reportCppNames(const ir::Module& module, Diagnostics& diagnostics);

/// Reports overloads that C++ cannot tell apart, such as of an enumeration and of its integers.
void reportOverloads(const ir::Module& module, Diagnostics& diagnostics);

/// True for functions, variables and types that the headers of the C library declare in the global namespace.
bool isGlobalCName(std::string_view name);
/// True for structs of the C library, whose names kernels may have.
bool isCTag(std::string_view name);
/// True for macros of those headers, which replace a name in every namespace, and for keywords of GNU C++.
bool isMacro(std::string_view name);

}  // namespace skc::emit
