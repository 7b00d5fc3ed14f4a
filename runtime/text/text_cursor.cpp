// SPDX-License-Identifier: MIT
#include "text/text_cursor.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <sk/error.hpp>

namespace sk::text {

namespace {

bool isBlank(char c) { return c == ' ' || c == '\t'; }
std::string shown(std::string_view word) { return std::string(word.substr(0, 40)); }

/// Without a plus sign, which std::from_chars does not know.
std::string_view withoutPlus(std::string_view word) {
  return word.size() > 1 && word[0] == '+' && word[1] != '-' ? word.substr(1) : word;
}

/// Zero or infinity, by the decimal exponent of the first digit that is not 0: std::from_chars does not say which.
double beyondDouble(std::string_view number) {
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  const std::string_view mantissa = number.substr(0, e);
  const std::string_view digits = withoutPlus(number.substr(std::min(e + 1, number.size())));
  std::int64_t exponent = 0;
  if (std::from_chars(digits.data(), digits.data() + digits.size(), exponent).ec != std::errc())
    exponent = digits.starts_with('-') ? -INT32_MAX : INT32_MAX;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  const std::size_t first = mantissa.find_first_of("123456789");
  const bool isLarge = first != std::string_view::npos &&
                       exponent > static_cast<std::int64_t>(first) - static_cast<std::int64_t>(point);
  return std::copysign(isLarge ? HUGE_VAL : 0.0, number.starts_with('-') ? -1.0 : 1.0);
}

/// A number with one of Fortran's exponents as others write it: with D for E, or, where the exponent has three digits, without a letter.
std::string withExponent(std::string_view word) {
  std::string text(word);
  const std::size_t letter = text.find_first_of("dD");
  const std::size_t sign = text.find_first_of("+-", 1);
  if (letter != std::string::npos) {
    text[letter] = 'e';
  } else if (sign != std::string::npos && text.find('.') < sign && text.size() - sign == 4) {
    text.insert(sign, 1, 'e');
  }
  return text;
}

}  // namespace

std::string_view withoutMark(std::string_view text) {
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

std::size_t lineEndAt(std::string_view text, std::size_t at) {
  if (at >= text.size() || (text[at] != '\n' && text[at] != '\r')) return 0;
  return text.substr(at, 2) == "\r\n" ? 2 : 1;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view()
                                         : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

std::optional<double> numberIn(std::string_view word) {
  const std::string_view digits = withoutPlus(word);
  double value = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) return std::nullopt;
  return error == std::errc::result_out_of_range ? beyondDouble(digits) : value;
}

TextCursor::TextCursor(std::string file, std::string_view text, TextRules rules)
    : file_(std::move(file)), text_(text), rules_(rules), next_(text.size() - withoutMark(text).size()) {
  begin_ = next_;
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    fail("the text is UTF-16; save it as UTF-8");
}

bool TextCursor::nextLine() {
  while (continues_ && enterLine()) {
  }
  return enterLine();
}

bool TextCursor::enterLine() {
  continues_ = false;
  if (next_ >= text_.size()) return false;
  ++line_;
  begin_ = at_ = wordAt_ = next_;
  lineEnd_ = std::min(text_.find_first_of("\r\n", next_), text_.size());
  next_ = lineEnd_ + lineEndAt(text_, lineEnd_);
  end_ = lineEnd_;
  if (rules_.comment != '\0') {
    for (std::size_t i = text_.substr(0, lineEnd_).find(rules_.comment, begin_); i < lineEnd_;
         i = text_.substr(0, lineEnd_).find(rules_.comment, i + 1)) {
      if (i > begin_ && !isBlank(text_[i - 1])) continue;
      end_ = i;
      return true;  // a backslash in a comment continues nothing
    }
  }
  const std::string_view words = trimmed(text_.substr(begin_, end_ - begin_));
  continues_ = rules_.continues && words.ends_with('\\');
  if (continues_) end_ = static_cast<std::size_t>(words.data() - text_.data()) + words.size() - 1;
  return true;
}

std::string_view TextCursor::word() {
  while (true) {
    while (at_ < end_ && isBlank(text_[at_])) ++at_;
    wordAt_ = at_;
    if (at_ < end_) break;
    if (!continues_ || !enterLine()) return {};
  }
  while (at_ < end_ && !isBlank(text_[at_])) ++at_;
  return text_.substr(wordAt_, at_ - wordAt_);
}

std::string_view TextCursor::wordOnAnyLine() {
  std::string_view next = word();
  while (next.empty() && nextLine()) next = word();
  return next;
}

std::string_view TextCursor::rest() {
  word();
  at_ = end_;
  return trimmed(text_.substr(wordAt_, end_ - wordAt_));
}

std::optional<double> TextCursor::number() {
  const std::string_view next = word();
  if (next.empty()) return std::nullopt;
  return numberOf(next);
}

double TextCursor::needNumber(std::string_view what) {
  const std::optional<double> n = number();
  if (!n) fail(fmt::format("{} is missing", what));
  return *n;
}

std::int64_t TextCursor::needInteger(std::string_view what) {
  const std::string_view next = word();
  if (next.empty()) fail(fmt::format("{} is missing", what));
  return integerOf(next);
}

void TextCursor::endLine(std::string_view form) {
  if (const std::string_view next = word(); !next.empty())
    fail(fmt::format("'{}' is too much; {}", shown(next), form));
}

double TextCursor::numberOf(std::string_view word) const {
  std::optional<double> value = numberIn(word);
  if (!value) value = numberIn(withExponent(word));
  if (!value) fail(fmt::format("'{}' is no number", shown(word)));
  return *value;
}

std::int64_t TextCursor::integerOf(std::string_view word) const {
  const std::string_view digits = withoutPlus(word);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size())
    fail(fmt::format("'{}' is no integer", shown(word)));
  return value;
}

std::string TextCursor::placed(std::string_view message) const {
  return fmt::format("{}:{}:{}: {}", file_, std::max<std::size_t>(line_, 1),
                     wordAt_ - std::min(wordAt_, begin_) + 1, message);
}

void TextCursor::fail(std::string_view message) const {
  throw sk::Error(placed(message), sk::Error::Kind::File);
}

void TextCursor::failForMemory(std::string_view message) const {
  throw sk::Error(placed(message), sk::Error::Kind::Memory);
}

std::size_t TextCursor::bytesBehind() const {
  const std::size_t first = text_.find_first_of("\r\n");
  const bool endsInReturns = first < text_.size() && text_[first] == '\r' && lineEndAt(text_, first) == 1;
  return endsInReturns ? std::min(lineEnd_ + 1, text_.size()) : next_;
}

}  // namespace sk::text
