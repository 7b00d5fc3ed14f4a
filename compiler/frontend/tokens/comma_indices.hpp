// SPDX-License-Identifier: MIT
//
// Reports `a[i, j]` for a gather or scatter output of several dimensions before Clang sees it. C++20 drops
// `i` with a warning; Clang would then complain that the remaining row is not an element. The fix-it:
//
//   r = a[i, j];              r = a[i][j];
#pragma once

#include <vector>

#include <clang/Lex/Token.h>

#include "support/diagnostics.hpp"

namespace skc::frontend {

/// A parameter that is read or written at an index.
struct IndexedParameter {
  clang::Token name;
  int rank;
};

/// Reports each subscript of `parameters` in a body that has a comma between indices.
void rejectCommaIndices(const std::vector<clang::Token>& body,
                        const std::vector<IndexedParameter>& parameters, Diagnostics& diagnostics);

}  // namespace skc::frontend
