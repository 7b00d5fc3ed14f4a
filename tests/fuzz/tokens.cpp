// SPDX-License-Identifier: MIT
#include "tokens.hpp"

#include <algorithm>
#include <cctype>

namespace fuzz {
namespace {

bool isWordChar(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool isDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool isSpace(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

/// The position after the next `end`, or the end of the text.
std::size_t behind(std::string_view text, std::string_view end, std::size_t from) {
  const std::size_t at = text.find(end, from);
  return at == std::string_view::npos ? text.size() : at + end.size();
}

template <class Belongs>
std::size_t whileTrue(std::string_view text, std::size_t at, Belongs belongs) {
  while (at < text.size() && belongs(text[at])) ++at;
  return at;
}

std::size_t markEnd(std::string_view text, std::size_t at) {
  static constexpr std::string_view longMarks[] = {"<<=", ">>=", "<>", "[]", "[[", "]]", "::", "->", "++",
                                                   "--",  "&&",  "||", "==", "!=", "<=", ">=", "+=", "-=",
                                                   "*=",  "/=",  "%=", "&=", "|=", "^=", "<<", ">>", "##"};
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("//")) return behind(text, "\n", at);
  if (rest.starts_with("/*")) return behind(text, "*/", at + 2);
  for (const std::string_view mark : longMarks) {
    if (rest.starts_with(mark)) return at + mark.size();
  }
  return at + 1;
}

}  // namespace

std::vector<Token> tokensOf(std::string_view text) {
  std::vector<Token> tokens;
  for (std::size_t begin = 0, end = 0; begin < text.size(); begin = end) {
    const char c = text[begin];
    TokenKind kind = TokenKind::Mark;
    if (isSpace(c)) {
      kind = TokenKind::Space;
      end = whileTrue(text, begin, isSpace);
    } else if (isDigit(c)) {
      kind = TokenKind::Number;
      end = whileTrue(text, begin, [](char d) { return isWordChar(d) || d == '.'; });
    } else if (isWordChar(c)) {
      kind = TokenKind::Word;
      end = whileTrue(text, begin, isWordChar);
    } else if (c == '"') {
      end = behind(text, "\"", begin + 1);
    } else {
      end = markEnd(text, begin);
    }
    tokens.push_back({kind, std::string(text.substr(begin, end - begin))});
  }
  return tokens;
}

std::string join(const std::vector<Token>& tokens) {
  std::string text;
  for (const Token& token : tokens) text += token.text;
  return text;
}

}  // namespace fuzz
