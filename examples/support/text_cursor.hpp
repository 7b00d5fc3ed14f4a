// SPDX-License-Identifier: MIT
//
// Words of a text file with their lines and columns. It knows no format.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace examples {

class TextCursor {
 public:
  TextCursor(std::string file, std::string_view text) : file_(std::move(file)), text_(text) {}

  /// Goes to the next line. False at the end of the text; the first call goes to the first line.
  bool nextLine() {
    if (started_) at_ = std::min(end_ + 1, text_.size() + 1);
    started_ = true;
    if (at_ >= text_.size()) return false;
    ++line_;
    begin_ = at_;
    end_ = std::min(text_.find('\n', at_), text_.size());
    return true;
  }
  /// The next word of the line; empty at its end.
  std::string_view word() {
    while (at_ < end_ && isBlank(text_[at_])) ++at_;
    wordAt_ = at_;
    while (at_ < end_ && !isBlank(text_[at_])) ++at_;
    return text_.substr(wordAt_, at_ - wordAt_);
  }
  /// The next word as a number, infinities and NaN included; none at the end of the line. Throws where it is none.
  std::optional<double> number() {
    const std::string_view w = word();
    if (w.empty()) return std::nullopt;
    return numberOf(w);
  }
  double needNumber(std::string_view what) {
    const std::optional<double> n = number();
    if (!n) fail(fmt::format("{} is missing", what));
    return *n;
  }
  double numberOf(std::string_view w) const {
    double value = 0.0;
    const std::string_view digits = !w.empty() && w.front() == '+' ? w.substr(1) : w;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::result_out_of_range) return outOfRange(digits);
    if (error != std::errc() || end != digits.data() + digits.size())
      fail(fmt::format("'{}' is no number", shown(w)));
    return value;
  }
  /// As `number`, but whole.
  std::int64_t integerOf(std::string_view w) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(w.data(), w.data() + w.size(), value);
    if (error != std::errc() || end != w.data() + w.size()) fail(fmt::format("'{}' is no integer", shown(w)));
    return value;
  }
  /// Throws "FILE:LINE:COLUMN: message", at the latest word.
  [[noreturn]] void fail(std::string_view message) const {
    throw std::runtime_error(
        fmt::format("{}:{}:{}: {}", file_, std::max<std::size_t>(line_, 1), wordAt_ - begin_ + 1, message));
  }
  std::size_t line() const { return line_; }
  /// Where the next line begins in the text.
  std::size_t nextLineAt() const { return std::min(end_ + 1, text_.size()); }

 private:
  static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
  static std::string shown(std::string_view w) { return std::string(w.substr(0, 40)); }
  /// from_chars leaves the value alone: zero or infinity, by the exponent's sign.
  static double outOfRange(std::string_view digits) {
    const std::size_t e = digits.find_first_of("eE");
    const bool isSmall = e != std::string_view::npos && e + 1 < digits.size() && digits[e + 1] == '-';
    const double value = isSmall ? 0.0 : HUGE_VAL;
    return digits.front() == '-' ? -value : value;
  }

  std::string file_;
  std::string_view text_;
  bool started_ = false;
  std::size_t at_ = 0, begin_ = 0, end_ = 0, wordAt_ = 0, line_ = 0;
};

}  // namespace examples
