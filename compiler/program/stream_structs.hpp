// SPDX-License-Identifier: MIT
//
// Structs that allocate the streams that a .sk file declares: one per namespace, named after the file.
//
//   // heat.sk                                  // heat.sk.hpp
//   stream float u<height, width>;              struct HeatStreams {
//   stream float row<width>;                      HeatStreams(sk::Device& device, std::int64_t height,
//                                                             std::int64_t width);
//                                                 sk::Stream<float> u;
//                                                 ...
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "program/cpp_names.hpp"

namespace skc::emit {

struct StreamStruct {
  std::vector<std::string> scope;
  std::string name;
  std::vector<const ir::DeclaredStream*> streams;   ///< in file order
  std::vector<std::string> arguments;               ///< names of extents, in order of first use
};

/// The structs, in file order; their names differ from the names of element structs and callables.
std::vector<StreamStruct> streamStructs(const ir::Module& module, const std::vector<Callable>& callables,
                                        std::string_view fileName);

/// The declaration, without its namespace.
std::string declaration(const ir::Module& module, const StreamStruct& streams);
/// The constructor's definition, outside any namespace.
std::string constructor(const ir::Module& module, const StreamStruct& streams);

/// The structs that kernels and streams use, as indices into Module::structs, each after the structs that it contains.
std::vector<std::uint32_t> usedStructs(const ir::Module& module);

/// How deep the types that a kernel computes with nest structs, where GLSL has no doubles of its own: 1 for a struct of
/// numbers and for a double, 2 for a vector of doubles; 0 if there are none.
int structLevels(const ir::Module& module, const ir::Kernel& kernel);

}  // namespace skc::emit
