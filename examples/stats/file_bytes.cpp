// SPDX-License-Identifier: MIT
#include "file_bytes.hpp"

#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

namespace examples {

std::string readBytes(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored))
    throw std::runtime_error(fmt::format("'{}' does not exist", name));
  if (!std::filesystem::is_regular_file(file, ignored))
    throw std::runtime_error(fmt::format("'{}' is no file", name));
  std::string bytes(static_cast<std::size_t>(std::filesystem::file_size(file, ignored)), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    throw std::runtime_error(fmt::format("'{}' cannot be read", name));
  }
  if (bytes.empty()) throw std::runtime_error(fmt::format("'{}' is empty", name));
  return bytes;
}

}  // namespace examples
