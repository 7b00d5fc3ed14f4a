// SPDX-License-Identifier: MIT
#include "matrix_market.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <new>
#include <string_view>

#include <fmt/format.h>

#include "text/memory.hpp"
#include "text/text_cursor.hpp"
#include "text/text_file.hpp"

namespace sk::linear {

namespace {

using text::TextCursor;

enum class Symmetry { General, Symmetric, Skew };

struct Header {
  bool isArray = false;
  bool isPattern = false;
  bool isInteger = false;
  Symmetry symmetry = Symmetry::General;
};

std::string lower(std::string_view word) {
  std::string text(word);
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

Header readHeader(TextCursor& cursor) {
  if (!cursor.nextLine() || lower(cursor.word()) != "%%matrixmarket")
    cursor.fail("this is no Matrix Market file: the first line begins with '%%MatrixMarket'");
  if (lower(cursor.word()) != "matrix") cursor.fail("only the object 'matrix' can be read");
  Header header;
  const std::string format = lower(cursor.word());
  header.isArray = format == "array";
  if (!header.isArray && format != "coordinate") cursor.fail("the format is 'coordinate' or 'array'");
  const std::string field = lower(cursor.word());
  header.isPattern = field == "pattern";
  header.isInteger = field == "integer";
  if (field == "complex")
    cursor.fail("complex matrices cannot be solved here; write one of twice the size with real entries");
  if (!header.isPattern && !header.isInteger && field != "real" && field != "double")
    cursor.fail("the field is 'real', 'integer' or 'pattern'");
  if (header.isArray && header.isPattern) cursor.fail("an array has no pattern");
  const std::string symmetry = lower(cursor.word());
  if (symmetry == "symmetric")
    header.symmetry = Symmetry::Symmetric;
  else if (symmetry == "skew-symmetric")
    header.symmetry = Symmetry::Skew;
  else if (symmetry != "general")
    cursor.fail("the symmetry is 'general', 'symmetric' or 'skew-symmetric'");
  cursor.endLine("the line ends with the symmetry");
  cursor.setRules({.comment = '%'});  // the first line begins like a comment
  return header;
}

double finite(const TextCursor& cursor, std::string_view word) {
  const double value = cursor.numberOf(word);
  if (!std::isfinite(value)) cursor.fail(fmt::format("'{}' is not finite", word));
  return value;
}

/// A number of the file's field.
double valueOf(const TextCursor& cursor, std::string_view word, const Header& header) {
  const double value = finite(cursor, word);
  if (header.isInteger && value != std::floor(value))
    cursor.fail(fmt::format("'{}' is no integer, which the first line promises", word));
  return value;
}

/// Reads one matrix; `parseMarket` says in which order.
class Reader {
 public:
  Reader(TextCursor& cursor, const Header& header) : cursor_(cursor), header_(header) {}

  void readSize() {
    const std::string_view word = cursor_.wordOnAnyLine();
    if (word.empty()) cursor_.fail("the line with the size is missing");
    rows_ = cursor_.integerOf(word);
    columns_ = cursor_.needInteger("the number of columns");
    count_ = header_.isArray ? 0 : cursor_.needInteger("the number of entries");
    cursor_.endLine(header_.isArray ? "the size is ROWS COLUMNS" : "the size is ROWS COLUMNS ENTRIES");
    constexpr std::int64_t most = 0x7fffffff;
    if (rows_ < 0 || columns_ < 0 || count_ < 0 || rows_ > most || columns_ > most)
      cursor_.fail(
          fmt::format("a matrix of {} x {} with {} entries cannot be stored; extents are from 0 to {}", rows_,
                      columns_, count_, most));
    // Rows take memory, also empty ones, of which a small file may promise any number.
    constexpr std::int64_t free = std::int64_t{1} << 24, rowsPerEntry = 64;
    if ((rows_ - free) / rowsPerEntry > (header_.isArray ? rows_ * columns_ : count_))
      cursor_.fail(fmt::format("nearly all of {} rows are empty; is the size right?", rows_));
    if (header_.symmetry != Symmetry::General && rows_ != columns_)
      cursor_.fail(fmt::format("a symmetric matrix is square; this one has {} x {}", rows_, columns_));
    // What assemble() takes for rows at once, and operatorOf() for rows and columns; entries are bounded by the size of the file.
    try {
      text::requireMemory(fmt::format("a matrix of {} x {}", rows_, columns_),
                          40.0 * static_cast<double>(rows_) + 8.0 * static_cast<double>(columns_));
    } catch (const sk::Error& error) {
      cursor_.failForMemory(error.what());
    }
  }

  /// The file's own size bounds the memory that a wrong count may ask for.
  void readCoordinates(std::size_t fileSize) {
    entries_.reserve(std::min(static_cast<std::size_t>(count_) * 2, fileSize));
    for (std::int64_t i = 0; i < count_; ++i) {
      const std::string_view word = cursor_.wordOnAnyLine();
      if (word.empty()) cursor_.fail(fmt::format("the file ends after {} of {} entries", i, count_));
      const std::int64_t row = index(cursor_.integerOf(word), rows_, "row");
      const std::int64_t column = index(cursor_.needInteger("the column"), columns_, "column");
      double value = 1.0;
      if (!header_.isPattern) {
        const std::string_view number = cursor_.word();
        if (number.empty()) cursor_.fail("the value is missing");
        value = valueOf(cursor_, number, header_);
      }
      add(row, column, value);
      cursor_.endLine(header_.isPattern ? "an entry is ROW COLUMN" : "an entry is ROW COLUMN VALUE");
    }
  }

  /// Columns one after the other; of symmetric ones, the part from the diagonal on, or below it.
  void readArray() {
    for (std::int64_t column = 0; column < columns_; ++column) {
      const std::int64_t first =
          header_.symmetry == Symmetry::General ? 0 : column + (header_.symmetry == Symmetry::Skew ? 1 : 0);
      for (std::int64_t row = first; row < rows_; ++row) {
        const std::string_view word = cursor_.wordOnAnyLine();
        if (word.empty())
          cursor_.fail(fmt::format("the file ends before row {} of column {}", row + 1, column + 1));
        const double value = valueOf(cursor_, word, header_);
        if (value != 0.0) add(row, column, value);
        cursor_.endLine("an array has one number a line");
      }
    }
  }

  MarketFile finish() {
    if (!cursor_.wordOnAnyLine().empty()) cursor_.fail("the file goes on after its last entry");
    MarketFile file;
    try {
      file.matrix = assemble(rows_, columns_, entries_, &file.duplicates);
    } catch (const std::bad_alloc&) {
      cursor_.failForMemory(fmt::format("there is not enough memory for a matrix of {} x {} with {} entries",
                                        rows_, columns_, entries_.size()));
    }
    return file;
  }

 private:
  std::int64_t index(std::int64_t number, std::int64_t extent, std::string_view what) const {
    if (number < 1 || number > extent)
      cursor_.fail(fmt::format("there is no {} {}; {}s are from 1 to {}", what, number, what, extent));
    return number - 1;
  }

  void add(std::int64_t row, std::int64_t column, double value) {
    if (header_.symmetry != Symmetry::General && row < column)
      cursor_.fail(
          fmt::format("the entry ({}, {}) is above the diagonal; a symmetric file has those below it",
                      row + 1, column + 1));
    if (header_.symmetry == Symmetry::Skew && row == column && value != 0.0)
      cursor_.fail(fmt::format("the entry ({}, {}) of a skew-symmetric matrix is 0, not {}", row + 1,
                               column + 1, value));
    entries_.push_back({row, column, value});
    if (header_.symmetry != Symmetry::General && row != column)
      entries_.push_back({column, row, header_.symmetry == Symmetry::Skew ? -value : value});
  }

  TextCursor& cursor_;
  Header header_;
  std::int64_t rows_ = 0, columns_ = 0, count_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace

MarketFile parseMarket(std::string_view text, const std::string& name) {
  TextCursor cursor(name, text);
  const Header header = readHeader(cursor);
  Reader reader(cursor, header);
  reader.readSize();
  if (header.isArray)
    reader.readArray();
  else
    reader.readCoordinates(text.size());
  return reader.finish();
}

SparseMatrix readMatrixMarket(const std::filesystem::path& file, std::int64_t* duplicates) {
  MarketFile read = parseMarket(text::bytesOf(file, "the matrix"), file.string());
  if (duplicates != nullptr) *duplicates = read.duplicates;
  return std::move(read.matrix);
}

std::vector<double> readMatrixMarketVector(const std::filesystem::path& file) {
  const SparseMatrix m = readMatrixMarket(file);
  if (m.columns != 1 && m.rows != 1)
    throw sk::Error(fmt::format("{}: a vector has one column or one row; this matrix has {} x {}",
                                file.string(), m.rows, m.columns),
                    sk::Error::Kind::File);
  std::vector<double> values(static_cast<std::size_t>(std::max(m.rows, m.columns)), 0.0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.rows); ++i)
    for (auto k = static_cast<std::size_t>(m.starts[i]); k < static_cast<std::size_t>(m.starts[i + 1]); ++k)
      values[i + static_cast<std::size_t>(m.column[k])] = m.value[k];
  return values;
}

void writeMatrixMarket(const std::filesystem::path& file, const SparseMatrix& a) {
  std::string lines = fmt::format("%%MatrixMarket matrix coordinate real general\n{} {} {}\n", a.rows,
                                  a.columns, a.entries());
  for (std::size_t i = 0; i < static_cast<std::size_t>(a.rows); ++i)
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      fmt::format_to(std::back_inserter(lines), "{} {} {:.17g}\n", i + 1, a.column[k] + 1, a.value[k]);
  text::writeFile(file, lines);
}

void writeMatrixMarketVector(const std::filesystem::path& file, std::span<const double> values) {
  std::string lines = fmt::format("%%MatrixMarket matrix array real general\n{} 1\n", values.size());
  for (const double v : values) fmt::format_to(std::back_inserter(lines), "{:.17g}\n", v);
  text::writeFile(file, lines);
}

}  // namespace sk::linear
