// SPDX-License-Identifier: MIT
//
// Files to bytes, and raw floats to columns.
#include <bit>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "data.hpp"
#include "support/text_file.hpp"

namespace examples {
namespace {

float floatAt(const std::string& bytes, std::size_t number) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    bits |= std::uint32_t{static_cast<unsigned char>(bytes[4 * number + i])} << (8 * i);
  }
  const float value = std::bit_cast<float>(bits);
  return std::fpclassify(value) == FP_SUBNORMAL ? 0.0f : value;
}

}  // namespace

Data readBinary(const std::filesystem::path& file, int columns, BinaryOrder order) {
  const std::string bytes = readBytes(file);
  const auto width = static_cast<std::size_t>(columns);
  if (bytes.size() % (4 * width) != 0) {
    throw std::runtime_error(
        fmt::format("'{}' has {} bytes, which is no multiple of {} columns of 4 bytes; give the "
                    "right --columns",
                    file.string(), bytes.size(), columns));
  }
  const std::size_t rows = bytes.size() / (4 * width);
  Data data;
  for (std::size_t c = 0; c < width; ++c) {
    Column column{fmt::format("column {}", c + 1), {}};
    column.values.reserve(rows);
    for (std::size_t r = 0; r < rows; ++r) {
      column.values.push_back(floatAt(bytes, order == BinaryOrder::Rows ? r * width + c : c * rows + r));
    }
    data.columns.push_back(std::move(column));
  }
  return data;
}

std::string readBytes(const std::filesystem::path& file) {
  std::string bytes = bytesOf(file, "the table");
  if (bytes.empty()) throw std::runtime_error(fmt::format("'{}' is empty", file.string()));
  return bytes;
}

}  // namespace examples
