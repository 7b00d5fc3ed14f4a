// SPDX-License-Identifier: MIT
#include "file_bytes.hpp"

#include <stdexcept>

#include <fmt/format.h>

#include "support/text_file.hpp"

namespace examples {

std::string readBytes(const std::filesystem::path& file) {
  std::string bytes = bytesOf(file, "the table");
  if (bytes.empty()) throw std::runtime_error(fmt::format("'{}' is empty", file.string()));
  return bytes;
}

}  // namespace examples
