// SPDX-License-Identifier: MIT
#include "parsers/byte_mutation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "tokens.hpp"

namespace fuzz {
namespace {

constexpr std::size_t longest = std::size_t{1} << 16;

/// Numbers that parsers often get wrong.
constexpr std::string_view numbers[] = {"0",
                                        "-0",
                                        "-1",
                                        "1",
                                        "255",
                                        "65536",
                                        "2147483647",
                                        "2147483648",
                                        "4294967295",
                                        "4294967297",
                                        "9223372036854775807",
                                        "9223372036854775808",
                                        "-9223372036854775808",
                                        "18446744073709551615",
                                        "18446744073709551616",
                                        "0.1",
                                        "1e308",
                                        "1e999",
                                        "-1e999",
                                        "1e-999",
                                        "1e-45",
                                        "nan",
                                        "inf",
                                        "-inf",
                                        "0x7fffffffffffffff",
                                        "1_0",
                                        "1e",
                                        "123456789012345678901234567890"};

/// Texts that parsers often get wrong: invalid UTF-8, line ends, quotes, brackets.
constexpr std::string_view pieces[] = {"\xff",
                                       "\xc0\x80",
                                       "\xed\xa0\x80",
                                       "\xf4\x90\x80\x80",
                                       "\xe2\x82",
                                       "\xef\xbb\xbf",
                                       "\r",
                                       "\n",
                                       "\r\n",
                                       "\"",
                                       "'",
                                       "\"\"\"",
                                       "'''",
                                       "\\",
                                       "\\u",
                                       "\\ud800",
                                       "[",
                                       "]",
                                       "[[",
                                       "{",
                                       "}",
                                       ",",
                                       "=",
                                       ":",
                                       "#",
                                       ".",
                                       "a.",
                                       "-",
                                       "\x01",
                                       " "};

class ByteMutator {
 public:
  ByteMutator(std::span<const std::string> seeds, Random& random) : seeds_(seeds), random_(random) {}

  std::string make() {
    text_ = random_.pick(seeds_);
    int changes = 1;
    while (changes < 8 && random_.chance(1, 2)) ++changes;
    while (changes-- > 0) change();
    text_.resize(std::min(text_.size(), longest));
    return std::move(text_);
  }

 private:
  void change() {
    switch (random_.below(12)) {
      case 0: return text_.resize(place());
      case 1:
      case 2: return changeByte();
      case 3: return changeInteger();
      case 4:
      case 5: return changeNumber();
      case 6: text_.insert(place(), random_.pick(pieces)); return;
      case 7: text_.insert(place(), 1, '\0'); return;
      case 8: text_.erase(place(), 1 + random_.below(random_.chance(1, 4) ? 400 : 8)); return;
      case 9: return repeatPiece();
      case 10: text_.insert(place(), pieceOf(text_)); return;
      case 11: text_.insert(place(), pieceOf(random_.pick(seeds_))); return;
    }
  }

  /// The index of a random byte, or the end.
  std::size_t place() { return random_.below(text_.size() + 1); }

  std::string pieceOf(const std::string& from) {
    if (from.empty()) return {};
    return from.substr(random_.below(from.size()), 1 + random_.below(random_.chance(1, 4) ? 400 : 16));
  }

  void changeByte() {
    if (text_.empty()) return;
    char& byte = text_[random_.below(text_.size())];
    byte = static_cast<char>(random_.chance(1, 2) ? byte ^ (1 << random_.below(8)) : random_.below(256));
  }

  /// Replaces 1, 2 or 4 bytes by an extreme integer, such as a size in the header of a binary file.
  void changeInteger() {
    static constexpr std::uint32_t extremes[] = {0,          1,          0x7f,       0xff,      0x100,
                                                 0x7fff,     0xffff,     0x10000,    0x1000000, 0x7fffffff,
                                                 0x80000000, 0xfffffffe, 0xffffffff, 3,         0x4000};
    const std::size_t size = std::size_t{1} << random_.below(3);
    if (text_.size() < size) return;
    const std::size_t at = random_.below(text_.size() - size + 1);
    const std::uint32_t value = random_.pick(extremes);
    const bool isBigEndian = random_.chance(1, 2);
    for (std::size_t i = 0; i < size; ++i) {
      text_[at + i] = static_cast<char>(value >> (8 * (isBigEndian ? size - 1 - i : i)));
    }
  }

  void changeNumber() {
    std::vector<Token> tokens = tokensOf(text_);
    std::vector<Token*> found;
    for (Token& token : tokens) {
      if (token.kind == TokenKind::Number) found.push_back(&token);
    }
    if (found.empty()) return;
    random_.pick(found)->text = random_.pick(numbers);
    text_ = join(tokens);
  }

  /// Inserts a piece many times, which nests deeply if the piece opens a bracket.
  void repeatPiece() {
    const std::string piece = random_.chance(1, 2) ? std::string(random_.pick(pieces)) : pieceOf(text_);
    const std::size_t count = random_.chance(1, 8) ? longest / 2 : 1 + random_.below(300);
    std::string many;
    while (many.size() < count) many += piece.empty() ? "[" : piece;
    text_.insert(place(), many);
  }

  std::span<const std::string> seeds_;
  Random& random_;
  std::string text_;
};

}  // namespace

std::string mutatedBytes(std::span<const std::string> seeds, Random& random) {
  return ByteMutator(seeds, random).make();
}

}  // namespace fuzz
