// SPDX-License-Identifier: MIT
//
// The prelude: the C++ declarations that every .sk file sees. Vectors are Clang's ext_vector_type, so that
// swizzles and arithmetic come for free; gathers are class templates; intrinsics are generated from the
// table. Names that users should not write begin with `__sk_`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/type.hpp"

namespace clang {
class CXXRecordDecl;
}

namespace skc::frontend {

/// The prelude's text, wrapped in line markers that name it and mark it as a system header.
std::string preludeText();

/// The text of <sk/types.hpp> for .sk files, which include it where C++ shares a header with them: the names of its types.
std::string typesHeaderText();

/// The text of <sk/random.sk>: library/random.sk.
std::string_view randomHeaderText();

/// True for type names whose `T(...)` takes components or rows: "float2" .. "unorm8x4", "float2x2" ...
bool isVectorTypeName(std::string_view name);

/// The IR type of a prelude class: "unorm8", "unorm8x4", "float2x2". Clang has all other types.
std::optional<ir::Type> classType(std::string_view name);

/// The function that replaces `name(...)` in the edited token stream.
std::string vectorConstructorName(std::string_view name);

/// The template of a gather with this rank, 1 to 4: "gather_2d".
std::string gatherTemplateName(int rank);

/// The class of all gathers, as Clang prints it: "stream_gather<float, 2>". Programs write gather<float, 2>.
inline constexpr std::string_view gatherClass = "stream_gather";

/// The rank of a gather's class; 0 for any other class.
int gatherRank(const clang::CXXRecordDecl* record);

/// Names of the prelude that programs may declare themselves, and then have no other meaning: "gather", "index", "axis".
bool isYielding(std::string_view name);
/// Names of intrinsics that a program's template with the same name replaces, since C++ could not choose between the two.
bool isYieldingToTemplates(std::string_view name);

/// The class template of a scatter output with this rank, 1 to 4, or of a variable output for 0.
std::string appendTemplateName(int rank);

}  // namespace skc::frontend
