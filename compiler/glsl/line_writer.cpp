// SPDX-License-Identifier: MIT
#include "glsl/line_writer.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "support/text.hpp"

namespace skc::emit {
namespace {

constexpr std::size_t limit = 100;
constexpr std::uint32_t largestGap = 3;

}  // namespace

void LineWriter::raw(std::string_view text) {
  endLine();
  text_ += text;
}

void LineWriter::restart(Loc loc) {
  endLine();
  text_ += fmt::format("#line {} {}\n", loc.line, loc.file + 1);
  line_ = loc.line;
  file_ = loc.file;
  sourceLine_ = 0;
}

void LineWriter::put(int depth, Loc loc, std::string_view text) {
  if (joins(loc, text)) {
    current_ += " ";
    current_ += text;
    return;
  }
  endLine();
  if (loc.line != 0) align(loc);
  const std::string indented = std::string(static_cast<std::size_t>(2 * depth), ' ') + std::string(text);
  current_ = wrapLine(indented, limit);
  if (loc.line != 0) sourceLine_ = loc.line;
}

void LineWriter::append(std::string_view text) { current_ += text; }

void LineWriter::close(int depth, std::uint32_t openedAt, std::string_view text) {
  if (row_ == openedAt && !current_.empty()) {
    current_ += " ";
    current_ += text;
    return;
  }
  endLine();
  current_ = std::string(static_cast<std::size_t>(2 * depth), ' ') + std::string(text);
}

LineWriter LineWriter::trial() const {
  LineWriter writer;
  writer.current_ = current_;
  writer.line_ = line_;
  writer.row_ = row_;
  writer.file_ = file_;
  writer.sourceLine_ = sourceLine_;
  return writer;
}

std::string LineWriter::take() {
  endLine();
  return std::move(text_);
}

bool LineWriter::isAt(Loc loc) const {
  return !current_.empty() && loc.line != 0 && loc.line == sourceLine_ && loc.file == file_;
}

bool LineWriter::isNumbered(Loc loc) const {
  return !current_.empty() && loc.line == line_ && loc.file == file_;
}

bool LineWriter::isNext(Loc loc) const { return current_.empty() && loc.line == line_ && loc.file == file_; }

bool LineWriter::joins(Loc loc, std::string_view text) const {
  if (!isAt(loc)) return false;
  return current_.find('\n') == std::string::npos && current_.size() + 1 + text.size() <= limit;
}

void LineWriter::endLine() {
  if (current_.empty()) return;
  text_ += current_ + "\n";
  ++row_;
  line_ += 1 + static_cast<std::uint32_t>(std::count(current_.begin(), current_.end(), '\n'));
  current_.clear();
}

/// Moves the next line to the number of `loc`. A statement wrapped onto further lines is left there: its line
/// number is a little too large until the next location corrects it.
void LineWriter::align(Loc loc) {
  if (loc.file == file_ && loc.line == sourceLine_) return;
  const bool isNear = loc.file == file_ && loc.line >= line_ && loc.line - line_ <= largestGap;
  if (!isNear) return restart(loc);
  text_.append(loc.line - line_, '\n');
  line_ = loc.line;
}

}  // namespace skc::emit
