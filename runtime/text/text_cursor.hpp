// SPDX-License-Identifier: MIT
//
// Lines, words and numbers of text files. A byte order mark is passed over, and a line ends with LF, CR LF or CR, the last one also
// with the text. It knows no format beyond how that comments and continues lines.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace sk::text {

/// The text behind UTF-8's byte order mark, if it begins with one.
std::string_view withoutMark(std::string_view text);
/// Bytes of the line end at this position of the text: 0 where there is none, 1 for LF or CR, 2 for CR LF.
std::size_t lineEndAt(std::string_view text, std::size_t at);
/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);
/// The number that this word is, infinities and NaN included; nullopt if it is none. What a double cannot hold is infinite or zero.
std::optional<double> numberIn(std::string_view word);

struct TextRules {
  char comment = '\0';  ///< begins a comment at the start of a line or behind a blank; none if 0
  bool continues = false;  ///< whether a line that ends with a backslash continues in the next
};

class TextCursor {
 public:
  TextCursor(std::string file, std::string_view text, TextRules rules = {});
  /// Takes effect with the next line.
  void setRules(TextRules rules) { rules_ = rules; }

  /// Goes to the next line, past those that continue this one. False at the end of the text; the first call goes to the first line.
  bool nextLine();
  /// The next word of the line; empty at its end.
  std::string_view word();
  /// The next word of this line, or of the first later one that has any; empty at the end of the text.
  std::string_view wordOnAnyLine();
  /// What remains of the line, as one word.
  std::string_view rest();
  /// The next word as a number; nullopt at the end of the line. Throws if it is no number.
  std::optional<double> number();
  double needNumber(std::string_view what);
  std::int64_t needInteger(std::string_view what);
  /// Throws if there is another word in this line; `form` says what the line should be.
  void endLine(std::string_view form);

  /// As numberIn, and with the exponents that Fortran writes: 1.0D+3 and 1.0-100. Throws if the word is no number.
  double numberOf(std::string_view word) const;
  std::int64_t integerOf(std::string_view word) const;
  /// Throws sk::Error, "FILE:LINE:COLUMN: message", at the latest word.
  [[noreturn]] void fail(std::string_view message) const;
  /// The same for a file that does not fit in memory.
  [[noreturn]] void failForMemory(std::string_view message) const;
  /// Where the bytes behind this line begin, of which the first may look like a part of the line end: it ends like the first line.
  std::size_t bytesBehind() const;

 private:
  bool enterLine();
  std::string placed(std::string_view message) const;

  std::string file_;
  std::string_view text_;
  TextRules rules_;
  bool continues_ = false;  ///< the line goes on in the next one
  std::size_t next_ = 0;  ///< where the next line begins
  std::size_t begin_ = 0, end_ = 0, lineEnd_ = 0;  ///< of the line, of its words, and its line end
  std::size_t at_ = 0, wordAt_ = 0, line_ = 0;
};

}  // namespace sk::text
