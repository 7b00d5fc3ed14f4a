// SPDX-License-Identifier: MIT
//
// The structs by which a program allocates the streams that a .sk file declares: one for each namespace,
// named after the file.
//
//   // heat.sk                                  // heat.sk.hpp
//   stream float u<height, width>;              struct HeatStreams {
//   stream float row<width>;                      HeatStreams(sk::Device& device, std::int64_t height,
//                                                             std::int64_t width);
//                                                 sk::Stream<float> u;
//                                                 ...
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "program/cpp_names.hpp"

namespace skc::emit {

struct StreamStruct {
  std::vector<std::string> scope;
  std::string name;
  std::vector<const ir::DeclaredStream*> streams;   ///< in the order of the file
  std::vector<std::string> arguments;               ///< names of extents, in the order of first appearance
};

/// In the order of the file; their names differ from those of structs and callables.
std::vector<StreamStruct> streamStructs(const ir::Module& module, const std::vector<Callable>& callables,
                                        std::string_view fileName);

/// The declaration, without its namespace.
std::string declaration(const ir::Module& module, const StreamStruct& streams);
/// The constructor, outside of any namespace.
std::string constructor(const ir::Module& module, const StreamStruct& streams);

}  // namespace skc::emit
