// SPDX-License-Identifier: MIT
//
// Splits CSV text into records and fields. Knows nothing of numbers.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace examples {

class CsvRecords {
 public:
  /// `name` is the file's, for messages. The text must outlive the reader.
  CsvRecords(std::string_view text, char separator, std::string name);

  /// Reads the next record that is not blank into `fields`; false at the end. Throws std::runtime_error
  /// with the line of a quote that is not closed, or that has text after it.
  bool next(std::vector<std::string>& fields);
  /// Where the last record began, from 1.
  std::int64_t line() const { return recordLine_; }

 private:
  void record(std::vector<std::string>& fields);
  void quoted(std::string& field);
  void plain(std::string& field);
  void endLine();
  [[noreturn]] void fail(std::int64_t line, std::string_view what) const;

  std::string_view text_;
  char separator_;
  std::string name_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
  std::int64_t recordLine_ = 1;
};

}  // namespace examples
