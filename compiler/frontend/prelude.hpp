// SPDX-License-Identifier: MIT
//
// The prelude: the C++ declarations that every .sk file sees. Vectors are Clang's ext_vector_type,
// so swizzles and arithmetic come free; gathers are class templates; intrinsics are generated from
// the table. Names that users should not write begin with `__sk_`.
#pragma once

#include <string>

namespace skc::frontend {

/// Text of the prelude, wrapped in line markers that name it and mark it as a system header.
std::string preludeText();

/// True for the type names whose `T(...)` is a vector constructor: "float2" .. "bool4".
bool isVectorTypeName(std::string_view name);

/// The function that stands for `name(...)` in the edited token stream.
std::string vectorConstructorName(std::string_view name);

/// The class template of a gather of this rank, 1 to 4: "gather_2d".
std::string gatherTemplateName(int rank);

}  // namespace skc::frontend
