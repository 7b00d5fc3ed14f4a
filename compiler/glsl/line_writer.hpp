// SPDX-License-Identifier: MIT
//
// Writes text whose lines keep their numbers from the .sk file, so that a driver's message names the author's
// line. Statements that share a line still share it, gaps of a few lines are left blank, and a #line
// directive corrects larger differences.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "support/loc.hpp"

namespace skc::emit {

class LineWriter {
 public:
  /// Writes `text` unchanged, before any text that has a source location.
  void raw(std::string_view text);
  /// Writes a #line directive: the next line has the number of `loc`.
  void restart(Loc loc);
  /// Writes `text` for `loc`: on the current line if it shared that line in the .sk file, else on a new one.
  /// Long text is wrapped.
  void put(int depth, Loc loc, std::string_view text);
  /// Continues the current line, as for " else {".
  void append(std::string_view text);
  /// Writes the closing bracket of a block that was opened at row `openedAt`: on that line if it is still the
  /// current one, else on a line of its own.
  void close(int depth, std::uint32_t openedAt, std::string_view text);

  /// Ends the current line, if there is one.
  void endLine();

  /// The number of lines written, whatever their #line numbers; it does not change within a line.
  std::uint32_t row() const { return row_; }
  /// True if `loc` is on the source line of the text on the current line.
  bool isAt(Loc loc) const;
  /// True if a compiler gives the current line the number of `loc`.
  bool isNumbered(Loc loc) const;
  /// True if there is no current line, and the next one has the number of `loc`.
  bool isNext(Loc loc) const;
  /// A copy of this writer's position without its earlier lines, for trial output.
  LineWriter trial() const;
  /// Returns the text, with its last line ended.
  std::string take();

 private:
  void align(Loc loc);
  bool joins(Loc loc, std::string_view text) const;

  std::string text_;
  std::string current_;  ///< the current line, not yet in text_
  std::uint32_t line_ = 0;  ///< its number, as a compiler counts
  std::uint32_t row_ = 1;
  std::uint32_t file_ = 0;
  std::uint32_t sourceLine_ = 0;  ///< line in the .sk file of what was written last
};

}  // namespace skc::emit
