// SPDX-License-Identifier: MIT
//
// Converts between Clang's source locations and ours: Loc::token is a SourceLocation's raw encoding.
#pragma once

#include <clang/Basic/SourceLocation.h>
#include <clang/Lex/Token.h>

#include "support/loc.hpp"

namespace skc::frontend {

inline Loc locOf(clang::SourceLocation location) { return Loc{location.getRawEncoding(), 0, 0}; }
inline Loc locOf(const clang::Token& token) { return locOf(token.getLocation()); }
inline clang::SourceLocation clangLocation(Loc loc) {
  return clang::SourceLocation::getFromRawEncoding(loc.token);
}

}  // namespace skc::frontend
