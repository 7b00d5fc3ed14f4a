// SPDX-License-Identifier: MIT
//
// Prints the descriptors of a program as the constants of FILE.sk.cpp, as the schema has them. All that a constant refers to
// comes before it, once.
//
// Names the constants of FILE.sk.cpp and the symbols of native code: a kernel's name followed by words of constant_parts.def.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ir/ir.hpp"
#include "program/descriptors.hpp"
#include "program/native_requests.hpp"

namespace skc::emit {

enum class Part : std::uint8_t {
#define SKC_PART(Word) Word,
#include "program/constant_parts.def"
#undef SKC_PART
};

/// The words of all parts.
std::span<const std::string_view> partWords();
/// "Half".
std::string_view wordOf(Part part);
/// True if `text` starts with the word of a part.
bool startsWithPart(std::string_view text);

/// "diffuse" and Part::Half give "diffuseHalf".
inline std::string operator+(std::string name, Part part) { return std::move(name).append(wordOf(part)); }
/// "diffuseUnrolled4".
inline std::string numbered(const std::string& name, Part part, std::size_t number) {
  return name + part + std::to_string(number);
}
/// A prefix for the names of each unit's constants: "diffuse", "grayScott", "sum_2". Any two prefixes differ, whatever parts
/// follow: where kernels are named scale and scale_half, scaleHalfKernel belongs to the first and scaleHalf_2Kernel to the second.
std::vector<std::string> constantNames(const ir::Module& module, const Program& program);

/// A unique prefix for each table of the module: "sk_response".
std::vector<std::string> tableNames(const ir::Module& module);

/// The prefix for the reduce that combines digits of exact sums. All sums of a kind share it.
std::string exactCombinationName(const ir::Kernel& combine);

/// The prefix for the type of a uniform array.
std::string arrayName(std::size_t number);

/// The prefix for a struct that a transform has made.
std::string synthesizedStructName(const std::string& glslName);

/// `names` are constantNames(): a unit's descriptors are the constants NAMEKernel and NAMEReduction.
std::string constantsText(const ir::Module& module, const Program& program,
                          const std::vector<std::string>& names, const NativeRequests& requests);

/// "constexpr TYPE NAME[] = {ITEMS};\n"; nothing if there are no items.
std::string constantList(std::string_view type, const std::string& name,
                         const std::vector<std::string>& items);

}  // namespace skc::emit
