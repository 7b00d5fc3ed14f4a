// SPDX-License-Identifier: MIT
#include "csv_records.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "support/text_cursor.hpp"

namespace examples {

CsvRecords::CsvRecords(std::string_view text, char separator, std::string name)
    : text_(withoutMark(text)), separator_(separator), name_(std::move(name)) {}

bool CsvRecords::next(std::vector<std::string>& fields) {
  while (at_ < text_.size()) {
    record(fields);
    if (fields.size() > 1 || !trimmed(fields.front()).empty()) return true;
  }
  return false;
}

void CsvRecords::record(std::vector<std::string>& fields) {
  recordLine_ = line_;
  std::size_t count = 0;
  while (true) {
    if (fields.size() == count) fields.emplace_back();
    std::string& field = fields[count++];
    field.clear();
    if (at_ < text_.size() && text_[at_] == '"') {
      quoted(field);
    } else {
      plain(field);
    }
    if (at_ >= text_.size() || text_[at_] != separator_) break;
    ++at_;
  }
  fields.resize(count);
  endLine();
}

void CsvRecords::quoted(std::string& field) {
  const std::int64_t opened = line_;
  for (++at_; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '"') {
      if (at_ + 1 >= text_.size() || text_[at_ + 1] != '"') break;
      ++at_;
    }
    if (lineEndAt(text_, at_) == 1) ++line_;  // of CR LF, at its LF
    field += c;
  }
  if (at_ >= text_.size()) fail(opened, "a quote is opened but never closed");
  ++at_;
  if (at_ < text_.size() && text_[at_] != separator_ && lineEndAt(text_, at_) == 0) {
    fail(line_, "text follows a closing quote; double the quotes within a quoted field");
  }
}

void CsvRecords::plain(std::string& field) {
  const std::size_t begin = at_;
  while (at_ < text_.size() && text_[at_] != separator_ && lineEndAt(text_, at_) == 0) ++at_;
  field.assign(text_.substr(begin, at_ - begin));
}

void CsvRecords::endLine() {
  at_ += lineEndAt(text_, at_);
  ++line_;
}

void CsvRecords::fail(std::int64_t line, std::string_view what) const {
  throw std::runtime_error(fmt::format("{}:{}: {}", name_, line, what));
}

}  // namespace examples
