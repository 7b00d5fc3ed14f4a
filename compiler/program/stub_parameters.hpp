// SPDX-License-Identifier: MIT
//
// Prints the kernels and parameters of descriptors for FILE.sk.cpp, and the names of the constants to which they refer.
#pragma once

#include <cstddef>
#include <string>

#include "glsl/type_names.hpp"
#include "ir/ir.hpp"
#include "sk/program.hpp"

namespace skc::emit {

/// The name of the constant that holds a parameter's condition.
std::string conditionName(const std::string& unit, const sk::program::Parameter& param);

/// The name of the constant that describes the element of a uniform array.
std::string elementName(const std::string& unit, const sk::program::Parameter& param);

/// The definition of the constant that holds a gather's reach; empty if nothing is known of it.
std::string haloText(const std::string& unit, const sk::program::Parameter& param);
/// What refers to that constant, and to the layers of parameter `number`, after parameterText().
std::string lastMembers(const std::string& unit, const sk::program::Parameter& param, std::size_t number);

/// A pointer to the descriptor of the elements of this type.
std::string elementOf(const ir::Module& module, const TypeNames& types, ir::Type type);

/// A parameter's initializer, without the closing bracket.
std::string parameterText(const ir::Module& module, const TypeNames& types, const std::string& unit,
                          const sk::program::Parameter& param, const ir::KernelParam& declared);

/// A kernel's initializer. One member per line; the first follows the bracket if that is far to the right.
std::string kernelText(const sk::program::Kernel& kernel, const std::string& name, std::size_t column,
                       const std::string& codeSymbol = {});

}  // namespace skc::emit
