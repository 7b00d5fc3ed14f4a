// SPDX-License-Identifier: MIT
//
// Which included files C++ includes, too.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace skc {

/// True for "hit.h" and the like: what such a file declares is the program's own, so stubs include it instead of declaring it again.
inline bool isCppHeader(std::string_view file) {
  constexpr std::array<std::string_view, 5> extensions = {".h", ".hh", ".hpp", ".hxx", ".h++"};
  return std::ranges::any_of(extensions, [&](std::string_view end) { return file.ends_with(end); });
}

/// True for "heat.sk": kernels belong to the file of this kind that they are written in.
inline bool isKernelFile(std::string_view file) { return file.ends_with(".sk"); }

}  // namespace skc
