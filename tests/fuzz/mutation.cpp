// SPDX-License-Identifier: MIT
#include "mutation.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "tokens.hpp"

namespace fuzz {
namespace {

/// Words of the language, and of C++ and GLSL.
constexpr std::string_view words[] = {
#define SKF_WORD(text) text,
#include "words.def"
#undef SKF_WORD
};

constexpr std::string_view numbers[] = {"0",
                                        "1",
                                        "-1",
                                        "2",
                                        "3",
                                        "4",
                                        "5",
                                        "8",
                                        "16",
                                        "17",
                                        "31",
                                        "32",
                                        "33",
                                        "64",
                                        "255",
                                        "256",
                                        "4095",
                                        "4096",
                                        "4097",
                                        "65535",
                                        "65536",
                                        "100000",
                                        "16777217",
                                        "2147483647",
                                        "2147483648",
                                        "4294967295",
                                        "4294967296",
                                        "-2147483648",
                                        "9223372036854775807",
                                        "18446744073709551615",
                                        "99999999999999999999",
                                        "0x7fffffff",
                                        "0xffffffffu",
                                        "0b101",
                                        "07",
                                        "1e38",
                                        "1e39",
                                        "3.4028236e38",
                                        "1e-45",
                                        "1e-46",
                                        "1e400",
                                        "0.0",
                                        "-0.0",
                                        "0.1",
                                        "1.5f",
                                        "1e5",
                                        "0x1p127",
                                        ".5",
                                        "1'000",
                                        "1u",
                                        "1ull",
                                        "'a'",
                                        "'\\n'",
                                        "u8'x'",
                                        "1.0L",
                                        "0.0/0.0",
                                        "1/0",
                                        "1<<31",
                                        "1<<32",
                                        "1.f",
                                        "1.0h"};

constexpr std::string_view bytes[] = {"\xff",
                                      "\xc3\xa4",
                                      "\xe2\x82\xac",
                                      "\xf0\x9f\x98\x80",
                                      "\xc0\x80",
                                      "\xed\xa0\x80",
                                      "\r",
                                      "\\\n",
                                      "\\",
                                      "`",
                                      "$",
                                      "@",
                                      "\x01",
                                      "\x7f",
                                      "\xef\xbb\xbf",
                                      "?"
                                      "?/",
                                      "\"",
                                      "'",
                                      "\t\v\f",
                                      "R\"x(",
                                      "\xe2\x80\xae",
                                      "\n#",
                                      "_Pragma(\"x\")"};

constexpr std::string_view brackets[] = {"(", ")",  "{",  "}",  "[",  "]", "<",
                                         ">", "[[", "]]", "<>", "[]", ";", ","};

constexpr std::string_view types[] = {
    "bool",   "int",     "uint",     "float",     "half",     "double",   "char",    "ushort",
    "unorm8", "bool2",   "bool4",    "int2",      "int3",     "int4",     "uint2",   "uint4",
    "float2", "float3",  "float4",   "half2",     "half4",    "double2",  "char4",   "uchar3",
    "short2", "ushort4", "unorm8x4", "snorm16x2", "float2x2", "float3x3", "float4x4"};
constexpr std::string_view operators[] = {"+",  "-", "*",  "/",  "%",  "&",  "|",  "^", "<<",
                                          ">>", "<", "<=", ">=", "==", "!=", "&&", "||"};
constexpr std::string_view assignments[] = {
    "=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="};

class Mutator {
 public:
  Mutator(const Corpus& corpus, Random& random) : corpus_(corpus), random_(random) {}

  Program make() {
    program_ = corpus_.pick(random_);
    const bool isGentle = random_.chance(1, 2);
    int changes = 1;
    while (changes < 8 && random_.chance(1, isGentle ? 3 : 2)) ++changes;
    while (changes-- > 0) isGentle ? changeGently() : change();
    return std::move(program_);
  }

 private:
  /// Makes a change that often leaves a valid program, so that the phases after the parser are tested, too.
  void changeGently() {
    tokens_ = tokensOf(program_.text);
    if (tokens_.empty()) return;
    switch (random_.below(6)) {
      case 0: replaceNumber(); break;
      case 1: replaceOneOf(types); break;
      case 2: replaceOneOf(operators); break;
      case 3: replaceOneOf(assignments); break;
      case 4: renameWord(); break;
      case 5: return changeLines();
    }
    program_.text = join(tokens_);
  }

  /// Replaces a token that is one of `alike` by another of them, if there is such a token.
  void replaceOneOf(std::span<const std::string_view> alike) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      if (std::ranges::find(alike, tokens_[i].text) != alike.end()) found.push_back(i);
    }
    if (!found.empty()) tokens_[random_.pick(found)].text = std::string(random_.pick(alike));
  }

  void change() {
    // Most changes are small and leave a nearly valid program: an early error hides everything after it.
    switch (random_.below(20)) {
      case 0: changeBytes(); break;
      case 1: changeLines(); break;
      case 2: nest(); break;
      default: changeTokens(); break;
    }
  }

  // ---- tokens -----------------------------------------------------------------------------------

  void changeTokens() {
    tokens_ = tokensOf(program_.text);
    if (tokens_.empty()) return;
    switch (random_.below(12)) {
      case 0: erase(spot(), 1 + random_.below(3)); break;
      case 1: insert(spot(), piece(tokens_)); break;
      case 2: std::swap(tokens_[spot()], tokens_[spot()]); break;
      case 3: insert(spot(), {{TokenKind::Word, " " + std::string(random_.pick(words)) + " "}}); break;
      case 4: replaceWord(std::string(random_.pick(words))); break;
      case 5:
      case 6: replaceNumber(); break;
      case 7: insert(spot(), {{TokenKind::Mark, std::string(random_.pick(brackets))}}); break;
      case 8: insert(spot(), piece(tokensOf(corpus_.pick(random_).text))); break;
      case 9: renameWord(); break;
      case 10: replacePiece(); break;
      case 11: swapMark(); break;
    }
    program_.text = join(tokens_);
  }

  std::size_t spot() { return random_.below(tokens_.size()); }

  /// The index of a random token of the kind, or of any token if there is none.
  std::size_t spotOf(TokenKind kind) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < tokens_.size(); ++i) {
      if (tokens_[i].kind == kind) found.push_back(i);
    }
    return found.empty() ? spot() : random_.pick(found);
  }

  void erase(std::size_t at, std::size_t count) {
    const auto first = tokens_.begin() + static_cast<std::ptrdiff_t>(at);
    tokens_.erase(first, first + static_cast<std::ptrdiff_t>(std::min(count, tokens_.size() - at)));
  }

  void insert(std::size_t at, const std::vector<Token>& tokens) {
    tokens_.insert(tokens_.begin() + static_cast<std::ptrdiff_t>(at), tokens.begin(), tokens.end());
  }

  std::vector<Token> piece(const std::vector<Token>& from) {
    if (from.empty()) return {};
    const std::size_t begin = random_.below(from.size());
    const std::size_t length = 1 + random_.below(random_.chance(1, 4) ? 60 : 8);
    const std::size_t end = std::min(begin + length, from.size());
    return {from.begin() + static_cast<std::ptrdiff_t>(begin),
            from.begin() + static_cast<std::ptrdiff_t>(end)};
  }

  void replaceWord(std::string word) { tokens_[spotOf(TokenKind::Word)].text = std::move(word); }
  void replaceNumber() { tokens_[spotOf(TokenKind::Number)].text = std::string(random_.pick(numbers)); }

  /// Replaces a word by another word of the program: a type or a name by another.
  void renameWord() {
    const std::string word = tokens_[spotOf(TokenKind::Word)].text;
    replaceWord(word);
  }

  void replacePiece() {
    const std::vector<Token> other = piece(tokens_);
    const std::size_t at = spot();
    erase(at, 1 + random_.below(8));
    insert(at, other);
  }

  void swapMark() {
    static constexpr std::string_view marks[] = {"+",  "-", "*",  "/",  "%", "&",  "|",  "^",   "<<",
                                                 ">>", "<", ">=", "==", "=", "+=", "-=", "<<=", "&&",
                                                 "||", "!", "~",  "?",  ":", ".",  "->", "::",  "++"};
    tokens_[spotOf(TokenKind::Mark)].text = std::string(random_.pick(marks));
  }

  // ---- lines, bytes, nesting --------------------------------------------------------------------

  void changeLines() {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < program_.text.size();) {
      const std::size_t end = std::min(program_.text.find('\n', begin), program_.text.size() - 1) + 1;
      lines.push_back(program_.text.substr(begin, end - begin));
      begin = end;
    }
    if (lines.empty()) return;
    const std::size_t at = random_.below(lines.size());
    switch (random_.below(3)) {
      case 0: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
      case 1: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(at), random_.pick(lines)); break;
      case 2: std::swap(lines[at], lines[random_.below(lines.size())]); break;
    }
    program_.text.clear();
    for (const std::string& line : lines) program_.text += line;
  }

  void changeBytes() {
    std::string& text = program_.text;
    if (text.empty()) return;
    const std::size_t at = random_.below(text.size());
    switch (random_.below(5)) {
      case 0: text.resize(at); break;
      case 1: text.insert(at, random_.pick(bytes)); break;
      case 2: text[at] = static_cast<char>(random_.below(256)); break;
      case 3: text.insert(at, 1, '\0'); break;
      case 4: text.erase(at, 1 + random_.below(16)); break;
    }
  }

  /// Inserts the same opening bracket, operator or statement head many times.
  void nest() {
    static constexpr std::string_view openings[] = {"(",
                                                    "{",
                                                    "[",
                                                    "-",
                                                    "!",
                                                    "~",
                                                    "x<",
                                                    "if (1) ",
                                                    "1+",
                                                    "1?",
                                                    "1,",
                                                    "f(",
                                                    "float(",
                                                    "(int)",
                                                    "for (;;)",
                                                    "a[",
                                                    "do ",
                                                    "*",
                                                    "&",
                                                    "[[",
                                                    "<",
                                                    "x.",
                                                    "x::",
                                                    "namespace n {",
                                                    "{ {",
                                                    "=",
                                                    "1||(",
                                                    "switch(1){case 1:",
                                                    "struct S {",
                                                    "+-",
                                                    "template <class T> "};
    const std::string_view opening = random_.pick(openings);
    std::string many;
    for (std::size_t left = random_.chance(1, 8) ? 4000 : 1 + random_.below(400); left > 0; --left)
      many += opening;
    tokens_ = tokensOf(program_.text);
    if (!tokens_.empty()) insert(spot(), {{TokenKind::Mark, many}});
    program_.text = join(tokens_);
  }

  const Corpus& corpus_;
  Random& random_;
  Program program_;
  std::vector<Token> tokens_;
};

}  // namespace

Program mutant(const Corpus& corpus, Random& random) { return Mutator(corpus, random).make(); }

}  // namespace fuzz
