// SPDX-License-Identifier: MIT
//
// The prelude: the C++ declarations that every .sk file sees. Vectors are Clang's ext_vector_type,
// so swizzles and arithmetic come free; gathers are class templates; intrinsics are generated from
// the table. Names that users should not write begin with `__sk_`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/type.hpp"

namespace skc::frontend {

/// Text of the prelude, wrapped in line markers that name it and mark it as a system header.
std::string preludeText();

/// True for the type names whose `T(...)` is made of components or rows: "float2" .. "unorm8x4",
/// "float2x2" ...
bool isVectorTypeName(std::string_view name);

/// The type that a class of the prelude stands for: "unorm8", "unorm8x4", "float2x2". Vectors of the
/// others, and scalars, are types of Clang's.
std::optional<ir::Type> classType(std::string_view name);

/// The function that stands for `name(...)` in the edited token stream.
std::string vectorConstructorName(std::string_view name);

/// The class template of a gather of this rank, 1 to 4: "gather_2d".
std::string gatherTemplateName(int rank);

/// The class template of a scatter output of this rank, 1 to 4, or, for 0, of a variable output.
std::string appendTemplateName(int rank);

}  // namespace skc::frontend
