// SPDX-License-Identifier: MIT
//
// Text whose lines keep the numbers that they have in the .sk file, so that a driver's message names
// the author's line: what stood on one line stays on one line, gaps of a few lines are left blank,
// and where the two drift further apart a #line directive brings them together again.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "support/loc.hpp"

namespace skc::emit {

class LineWriter {
 public:
  /// Lines of `text` as they are, before any that has a place.
  void raw(std::string_view text);
  /// A #line directive: the next line is that of `loc`.
  void restart(Loc loc);
  /// Puts `text` at its place: on the line at hand if it stood there in the .sk file, too, else on a
  /// new one. Long text is wrapped.
  void put(int depth, Loc loc, std::string_view text);
  /// Goes on right after what was put last: " else {".
  void append(std::string_view text);
  /// A closing bracket for what was put when row() was `openedAt`: on that line if it still goes on,
  /// else on a line of its own.
  void close(int depth, std::uint32_t openedAt, std::string_view text);

  /// Ends the line at hand, if there is one.
  void endLine();

  /// Counts the lines written, however #line numbers them: the same while one line is at hand.
  std::uint32_t row() const { return row_; }
  /// True if `loc` is where the thing on the line at hand stands in the .sk file.
  bool isAt(Loc loc) const;
  /// True if a compiler gives the number of `loc` to the line at hand.
  bool isNumbered(Loc loc) const;
  /// True if no line is at hand, and the next one has the number of `loc`.
  bool isNext(Loc loc) const;
  /// A writer that stands where this one does, for trying something out; it has no earlier lines.
  LineWriter trial() const;
  /// The text, its last line ended.
  std::string take();

 private:
  void align(Loc loc);
  bool joins(Loc loc, std::string_view text) const;

  std::string text_;
  std::string current_;            ///< the line at hand, not yet in text_
  std::uint32_t line_ = 0;         ///< the number that a compiler gives to it
  std::uint32_t row_ = 1;
  std::uint32_t file_ = 0;
  std::uint32_t sourceLine_ = 0;   ///< where the thing that was put last stands in the .sk file
};

}  // namespace skc::emit
