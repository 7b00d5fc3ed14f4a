// SPDX-License-Identifier: MIT
//
// Columns of numbers, and where they come from: CSV, raw floats, or a made-up weather station.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace examples {

struct Column {
  std::string name;
  std::vector<float> values;  ///< NaN where one is missing
};

struct Data {
  std::vector<Column> columns;              ///< all of one length
  std::vector<std::string> textColumns;     ///< names of columns left out because they hold no numbers
};

struct CsvOptions {
  char separator = ',';
  std::vector<std::string> select;  ///< columns to read, in this order; empty for all
};

/// The bytes of a file. Throws std::runtime_error naming the file where it is missing, cannot be read or is empty.
std::string readBytes(const std::filesystem::path& file);

/// Reads CSV (RFC 4180: quotes, doubled quotes, line ends within quotes; lines end with LF, CR LF or CR). The first
/// line names the columns unless it is all numbers. An empty field, NA, NaN or null is a missing number, and
/// so is what a short line lacks (but not nearly all columns of nearly all lines). A column without a single number is text and left out, unless selected.
/// Throws std::runtime_error naming file, line and column for anything else that is no number.
Data readCsv(const std::filesystem::path& file, const CsvOptions& options);

enum class BinaryOrder : std::uint8_t {
  Rows,  ///< the first row's numbers, then the second's
  Columns,  ///< the first column's numbers, then the second's
};

/// Reads raw little-endian 32-bit floats. Throws std::runtime_error where the size does not fit.
Data readBinary(const std::filesystem::path& file, int columns, BinaryOrder order);

/// Writes ten years of hourly readings of a made-up weather station, with gaps, as CSV: the same on every
/// machine. Throws std::runtime_error where the file cannot be written.
void writeWeather(const std::filesystem::path& file);

}  // namespace examples
