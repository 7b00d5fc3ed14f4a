// SPDX-License-Identifier: MIT
//
// Takes the attributes in front of a parameter: [[wrap]], [[halo(2)]], [[range(0, 1)]].
#include "frontend/tokens/parameter_parts.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>

#include <clang/Lex/Preprocessor.h>

#include "frontend/clang_loc.hpp"
#include "frontend/tokens/token_cursor.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

namespace {

/// Takes a list of arguments with its parentheses; empty if there is none, or if it does not end.
std::vector<Token> takeArguments(const std::vector<Token>& parameter, std::size_t& at) {
  std::vector<Token> arguments;
  if (!isKind(parameter, at, tok::l_paren)) return arguments;
  int depth = 0;
  do {
    if (parameter[at].is(tok::l_paren)) ++depth;
    if (parameter[at].is(tok::r_paren)) --depth;
    arguments.push_back(parameter[at++]);
  } while (depth > 0 && at < parameter.size());
  return depth == 0 ? arguments : std::vector<Token>();
}

}  // namespace

/// [[clamp]] [[wrap]] [[mirror]] [[border(v)]] [[filter]] [[halo(2)]] [[range(0, 1)]] [[wrap, filter]]
bool ParameterEditor::takeAttributes(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  while (isKind(parameter, at, tok::l_square) && isKind(parameter, at + 1, tok::l_square)) {
    ++at;
    do {
      if (!takeAttribute(parameter, ++at, parts)) return false;
    } while (isKind(parameter, at, tok::comma));
    if (!isKind(parameter, at, tok::r_square) || !isKind(parameter, at + 1, tok::r_square)) {
      diagnostics_.report(Diag::AttributeEnd,
                          locOf(at < parameter.size() ? parameter[at] : parameter.back()));
      return false;
    }
    at += 2;
  }
  return true;
}

/// Takes one name between the brackets.
bool ParameterEditor::takeAttribute(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  if (at >= parameter.size()) {
    diagnostics_.report(Diag::ParameterAttribute, locOf(parameter.back()), {""});
    return false;
  }
  const Token& name = parameter[at++];
  if (isWord(name, "range")) return takeRange(parameter, at, parts);
  parts.attribute = name;
  parts.hasAttribute = true;
  if (isWord(name, "filter")) {
    parts.syntax.filter = true;
    return true;
  }
  if (isWord(name, "halo")) return takeHalo(parameter, at, parts);
  if (isWord(name, "clamp")) {
    parts.syntax.boundary = ir::Boundary::Clamp;
  } else if (isWord(name, "wrap")) {
    parts.syntax.boundary = ir::Boundary::Wrap;
  } else if (isWord(name, "mirror")) {
    parts.syntax.boundary = ir::Boundary::Mirror;
  } else if (isWord(name, "border")) {
    parts.syntax.boundary = ir::Boundary::Border;
  } else {
    diagnostics_.report(Diag::ParameterAttribute, locOf(name), {preprocessor_.getSpelling(name)});
    return false;
  }
  if (std::exchange(parts.hasBoundary, true)) {
    diagnostics_.report(Diag::BoundaryTwice, locOf(name), {nameOf(name)});
    return false;
  }
  return parts.syntax.boundary != ir::Boundary::Border || takeBorder(parameter, at, parts);
}

bool ParameterEditor::takeBorder(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  parts.border = takeArguments(parameter, at);
  if (parts.border.size() < 3) {
    diagnostics_.report(Diag::BorderValue, locOf(parts.attribute));
    return false;
  }
  return true;
}

/// Takes the two ends of [[range(lo, hi)]]: any constant expressions.
bool ParameterEditor::takeRange(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  const Token& name = parameter[at - 1];
  if (!parts.ends.empty()) {
    diagnostics_.report(Diag::RangeTwice, locOf(name));
    return false;
  }
  parts.range = name;
  const Tokens arguments = takeArguments(parameter, at);
  if (!arguments.empty()) parts.ends = splitAtCommas(arguments);
  if (parts.ends.size() != 2 || parts.ends.front().empty() || parts.ends.back().empty()) {
    diagnostics_.report(Diag::RangeForm, locOf(name));
    return false;
  }
  return true;
}

/// Takes the numbers of [[halo(...)]]: literals, which macros may stand for.
bool ParameterEditor::takeHalo(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  constexpr long farthest = 1 << 20;
  if (!parts.syntax.halo.empty()) {
    diagnostics_.report(Diag::HaloTwice, locOf(parts.attribute));
    return false;
  }
  bool isWellFormed = isKind(parameter, at, tok::l_paren);
  do {
    const bool isNumber = isWellFormed && isKind(parameter, ++at, tok::numeric_constant);
    const std::string text = isNumber ? preprocessor_.getSpelling(parameter[at++]) : "";
    char* end = nullptr;
    const long number = std::strtol(text.c_str(), &end, 0);
    isWellFormed = isNumber && *end == '\0' && number <= farthest;
    if (isWellFormed) parts.syntax.halo.push_back(static_cast<std::int32_t>(number));
  } while (isWellFormed && isKind(parameter, at, tok::comma));
  if (!isWellFormed || !isKind(parameter, at, tok::r_paren)) {
    diagnostics_.report(Diag::HaloForm, locOf(parts.attribute));
    return false;
  }
  ++at;
  return true;
}

}  // namespace skc::frontend
