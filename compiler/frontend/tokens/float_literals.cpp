// SPDX-License-Identifier: MIT
#include "frontend/tokens/float_literals.hpp"

#include <algorithm>
#include <cctype>
#include <cstring>

#include <clang/Lex/Preprocessor.h>

namespace skc::frontend {
namespace {

bool isHex(std::string_view text) { return text.starts_with("0x") || text.starts_with("0X"); }

/// True for the spelling of a double: with a point or an exponent, and without a suffix.
bool isDouble(std::string_view text) {
  const bool hasFraction = text.find_first_of(isHex(text) ? "pP" : ".eE") != std::string_view::npos;
  const char last = text.back();
  return hasFraction && (last == '.' || std::isdigit(static_cast<unsigned char>(last)) != 0);
}

}  // namespace

void suffixFloats(std::vector<clang::Token>& tokens, clang::Preprocessor& preprocessor) {
  for (clang::Token& token : tokens) {
    if (token.isNot(clang::tok::numeric_constant)) continue;
    const std::string text = preprocessor.getSpelling(token);
    if (!isDouble(text)) continue;
    // as long as the token, plus a terminating zero, past which Clang does not read
    auto* spelling = static_cast<char*>(preprocessor.getPreprocessorAllocator().Allocate(text.size() + 2, 1));
    std::memcpy(spelling, text.data(), text.size());
    std::memcpy(spelling + text.size(), "f", 2);
    token.setLiteralData(spelling);
    token.setLength(static_cast<unsigned>(text.size() + 1));
    token.clearFlag(clang::Token::NeedsCleaning);
  }
}

LiteralParts literalParts(std::string text) {
  std::erase(text, '\'');
  constexpr std::string_view suffixes[] = {"f", "F", "l", "L"};
  for (const std::string_view suffix : suffixes) {
    const bool isDigit = isHex(text) && text.find_first_of("pP") == std::string::npos;
    if (isDigit || !text.ends_with(suffix)) continue;
    text.pop_back();
    return {std::move(text), suffix};
  }
  return {std::move(text), ""};
}

}  // namespace skc::frontend
