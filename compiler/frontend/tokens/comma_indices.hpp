// SPDX-License-Identifier: MIT
//
// `a[i, j]` of a gather or scatter output with several dimensions: C++20 drops `i`, with a warning, and what is left
// names a row, of which Clang then says that it is no element. So it is told here, before Clang sees it:
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
void refuseCommaIndices(const std::vector<clang::Token>& body,
                        const std::vector<IndexedParameter>& parameters, Diagnostics& diagnostics);

}  // namespace skc::frontend
