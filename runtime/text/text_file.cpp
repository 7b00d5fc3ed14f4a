// SPDX-License-Identifier: MIT
#include "text/text_file.hpp"

#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sk/error.hpp>

#include "text/memory.hpp"

namespace sk::text {

std::string bytesOf(const std::filesystem::path& file, std::string_view what) {
  std::error_code unknown;
  const std::uintmax_t size = std::filesystem::file_size(file, unknown);
  if (!unknown) requireMemory(fmt::format("{} '{}'", what, file.string()), 2.0 * static_cast<double>(size));
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream bytes;
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored) || !stream || !(bytes << stream.rdbuf())) {
    // An empty file sets failbit, too.
    if (std::filesystem::is_regular_file(file, ignored) && std::filesystem::file_size(file, ignored) == 0)
      return {};
    throw sk::Error(fmt::format("{} '{}' does not exist or cannot be read", what, file.string()),
                    sk::Error::Kind::File);
  }
  return std::move(bytes).str();
}

void writeFile(const std::filesystem::path& file, std::string_view bytes) {
  std::error_code ignored;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), ignored);
  std::ofstream stream(file, std::ios::binary);
  if (!(stream << bytes).flush())
    throw sk::Error(fmt::format("cannot write '{}'", file.string()), sk::Error::Kind::File);
}

}  // namespace sk::text
