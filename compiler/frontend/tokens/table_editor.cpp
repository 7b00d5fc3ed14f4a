// SPDX-License-Identifier: MIT
#include "frontend/tokens/table_editor.hpp"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "frontend/clang_loc.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

namespace {

/// Splits `( ... )` at commas outside inner brackets.
std::vector<std::vector<Token>> argumentsOf(const std::vector<Token>& parenthesized) {
  std::vector<std::vector<Token>> arguments(1);
  int depth = 0;
  for (std::size_t i = 1; i + 1 < parenthesized.size(); ++i) {
    const Token& token = parenthesized[i];
    if (token.isOneOf(tok::l_paren, tok::l_square, tok::l_brace)) ++depth;
    if (token.isOneOf(tok::r_paren, tok::r_square, tok::r_brace)) --depth;
    if (depth == 0 && token.is(tok::comma)) {
      arguments.emplace_back();
    } else {
      arguments.back().push_back(token);
    }
  }
  return arguments;
}

bool isInterpolation(const std::vector<Token>& argument) {
  return argument.size() == 1 && (isWord(argument[0], "linear") || isWord(argument[0], "cubic"));
}

/// Checks for low, high, intervals and the interpolation.
bool areWellFormed(const std::vector<std::vector<Token>>& arguments) {
  if (arguments.size() != 4 || !isInterpolation(arguments[3])) return false;
  return !arguments[0].empty() && !arguments[1].empty() && !arguments[2].empty();
}

}  // namespace

bool namesTable(const TokenCursor& cursor) { return isWord(cursor.peek(2), "table"); }

std::optional<TableSyntax> takeTable(TokenCursor& cursor, std::size_t tokens, const TokenBuilder& builder,
                                     Diagnostics& diagnostics, int& constants, std::vector<Token>& out) {
  std::vector<Token> attribute;
  for (std::size_t i = 0; i < tokens; ++i) attribute.push_back(cursor.take());
  // [ [ table ( ... ) ] ]
  const Token name = attribute[2];
  const bool isCall = attribute.size() > 7 && attribute[3].is(tok::l_paren) &&
                      attribute[attribute.size() - 3].is(tok::r_paren);
  const std::vector<std::vector<Token>> arguments =
      isCall ? argumentsOf({attribute.begin() + 3, attribute.end() - 2}) : std::vector<std::vector<Token>>();
  if (!areWellFormed(arguments)) {
    diagnostics.report(Diag::TableForm, locOf(name));
    return std::nullopt;
  }
  const auto constant = [&](llvm::StringRef type, const std::vector<Token>& value) {
    const std::string constantName = fmt::format("__sk_constant{}", constants++);
    builder.constant(constantName, {builder.word(type, value.front().getLocation())}, value,
                     value.front().getLocation(), out);
    return constantName;
  };
  TableSyntax table;
  table.low = constant("float", arguments[0]);
  table.high = constant("float", arguments[1]);
  table.intervals = constant("int", arguments[2]);
  table.isCubic = isWord(arguments[3][0], "cubic");
  return table;
}

}  // namespace skc::frontend
