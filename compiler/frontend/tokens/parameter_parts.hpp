// SPDX-License-Identifier: MIT
//
// What ParameterEditor takes apart: shared by the files that take attributes and all other parts.
#pragma once

#include <cstddef>
#include <vector>

#include <clang/Lex/Token.h>

#include "frontend/tokens/parameter_editor.hpp"

namespace skc::frontend {

/// The parts of one parameter's declaration.
struct ParameterEditor::ParameterParts {
  clang::Token qualifier;                 ///< `out`, `reduce`, `iter` ..., or unset
  bool hasQualifier = false;
  std::vector<clang::Token> type;
  clang::Token name;
  bool isElement = false;          ///< `<>`
  int rank = 0;                    ///< number of empty bracket pairs
  clang::Token open, close;               ///< the first and last bracket of either kind
  std::vector<clang::Token> length;                   ///< `[9]` of a uniform array, with brackets
  int lengths = 0;                 ///< more than one is an error: an array of arrays
  bool isArrayReference = false;   ///< `T (&w)[9]`
  std::vector<clang::Token> value;                    ///< after `=`
  clang::Token attribute;                 ///< the last word in [[...]] that only gathers have
  bool hasAttribute = false;
  bool hasBoundary = false;
  std::vector<clang::Token> border;                   ///< the argument of border(...)
  clang::Token range;              ///< the word in [[range(...)]]
  std::vector<std::vector<clang::Token>> ends;  ///< the two arguments of range(...); empty if there is none
  std::vector<clang::Token> rest;  ///< of an ordinary parameter, after its name
  ParamSyntax syntax;
};

inline bool isKind(const std::vector<clang::Token>& tokens, std::size_t at, clang::tok::TokenKind kind) {
  return at < tokens.size() && tokens[at].is(kind);
}

}  // namespace skc::frontend
