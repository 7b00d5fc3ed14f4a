// SPDX-License-Identifier: MIT
#include "frontend/choices.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "frontend/clang_loc.hpp"

namespace skc::frontend {
namespace {

namespace tok = clang::tok;

/// An attribute and its allowed values, in the order of the enumerators after the first, Default.
struct Choice {
  std::string_view name;
  std::uint8_t ir::Choices::* member;
  std::array<std::string_view, 6> values;
  std::string_view list;  ///< for messages
};
constexpr std::array<Choice, 6> choices = {{
    {"precision",
     &ir::Choices::precision,
     {"", "half", "single", "extended", "double"},
     "half, single, extended, double"},
    {"accumulate",
     &ir::Choices::accumulate,
     {"", "tree", "compensated", "extended", "exact"},
     "tree, compensated, extended, exact"},
    {"intrinsics", &ir::Choices::intrinsics, {"", "fast", "accurate"}, "fast, accurate"},
    {"tables", &ir::Choices::tables, {"", "off", "on"}, "off, on"},
    {"contraction", &ir::Choices::contraction, {"", "exact", "fast"}, "exact, fast"},
    {"order", &ir::Choices::order, {"", "kept", "any"}, "kept, any"},
}};

/// The words of [[variants(...)]], in the order of ir::Ahead.
constexpr std::array<std::string_view, 4> variants = {"views", "half", "extended", "fast"};
constexpr std::string_view variantList = "views, half, extended, fast";

bool startsAttributes(const TokenCursor& cursor, std::size_t at) {
  return cursor.peek(at).is(tok::l_square) && cursor.peek(at + 1).is(tok::l_square);
}

/// The index after the `]]` that matches the bracket at `at`; 0 if there is none.
std::size_t behindBrackets(const TokenCursor& cursor, std::size_t at) {
  int depth = 0;
  for (; !cursor.peek(at).isOneOf(tok::eof, tok::semi, tok::l_brace, tok::r_brace); ++at) {
    if (cursor.peek(at).is(tok::l_square)) ++depth;
    if (cursor.peek(at).is(tok::r_square) && --depth == 0) return at + 1;
  }
  return 0;
}

/// Takes variants(WORD, ...), up to the bracket at least.
void takeVariants(TokenCursor& cursor, Diagnostics& diagnostics, const clang::Token& name,
                  ir::Choices& chosen) {
  if (!cursor.at(tok::l_paren)) return diagnostics.report(Diag::VariantForm, locOf(name), {variantList});
  bool isWord = true;
  do {
    cursor.take();  // '(' or ','
    const auto found = std::ranges::find(variants, nameOf(cursor.peek()));
    isWord = found != variants.end();
    if (!isWord) break;
    chosen.ahead |= static_cast<std::uint8_t>(1u << (found - variants.begin()));
    cursor.take();
  } while (cursor.at(tok::comma));
  if (!isWord || !cursor.at(tok::r_paren)) {
    const clang::Token& word = cursor.peek();
    if (nameOf(word).empty()) {
      diagnostics.report(Diag::VariantForm, locOf(word), {variantList});
    } else {
      diagnostics.report(Diag::VariantName, locOf(word), {nameOf(word), variantList});
    }
  }
  while (!cursor.peek().isOneOf(tok::r_paren, tok::r_square)) cursor.take();
  if (cursor.at(tok::r_paren)) cursor.take();
}

/// Takes NAME(VALUE). After an error, leaves the cursor at the first token that does not fit.
void takeChoice(TokenCursor& cursor, Diagnostics& diagnostics, ir::Choices& chosen) {
  const clang::Token name = cursor.take();
  if (nameOf(name) == "variants") return takeVariants(cursor, diagnostics, name, chosen);
  const auto choice = std::ranges::find(choices, nameOf(name), &Choice::name);
  if (choice == choices.end()) return diagnostics.report(Diag::ChoiceName, locOf(name), {nameOf(name)});
  const bool opens = cursor.at(tok::l_paren);
  const clang::Token value = opens ? cursor.peek(1) : name;
  const auto found = std::ranges::find(choice->values, nameOf(value));
  if (!opens || nameOf(value).empty() || found == choice->values.end() ||
      cursor.peek(2).isNot(tok::r_paren)) {
    return diagnostics.report(Diag::ChoiceValue, locOf(value),
                              {std::string(choice->name), std::string(choice->list)});
  }
  for (int token = 0; token < 3; ++token) cursor.take();
  chosen.*choice->member = static_cast<std::uint8_t>(found - choice->values.begin());
}

}  // namespace

std::size_t endOfChoices(const TokenCursor& cursor) {
  std::size_t at = 0;
  while (startsAttributes(cursor, at)) {
    at = behindBrackets(cursor, at);
    if (at == 0) return 0;
  }
  return at;
}

bool namesChoice(const TokenCursor& cursor) {
  const std::string name = nameOf(cursor.peek(2));
  return name == "variants" || std::ranges::find(choices, name, &Choice::name) != choices.end();
}

ir::Choices takeChoices(TokenCursor& cursor, std::size_t tokens, Diagnostics& diagnostics) {
  ir::Choices chosen;
  const clang::Token* const end = &cursor.peek(tokens);
  while (&cursor.peek() < end) {
    cursor.take();
    const bool starts =
        cursor.peek().isNot(tok::l_square) && cursor.peek().isNot(tok::r_square) && &cursor.peek() < end;
    if (starts) takeChoice(cursor, diagnostics, chosen);
    while (&cursor.peek() < end && !cursor.peek().isOneOf(tok::comma, tok::l_square, tok::r_square))
      cursor.take();
  }
  return chosen;
}

}  // namespace skc::frontend
