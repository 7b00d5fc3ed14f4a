// SPDX-License-Identifier: MIT
//
// A file begins with its key, so that two keys of one hash do not meet and a person can read what it is of.
#include "cache_folder.hpp"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

#include <unistd.h>

#include <fmt/format.h>

namespace sk {

namespace {

namespace fs = std::filesystem;

/// FNV-1a: names of files only.
std::uint64_t hashOf(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return hash;
}

/// The key as a line.
std::string headOf(std::string_view key) {
  std::string head(key);
  for (char& c : head) {
    if (c == '\n') c = ' ';
  }
  return head + '\n';
}

fs::path fileOf(const fs::path& folder, std::string_view name, std::string_view key) {
  return folder / fmt::format("{}-{:016x}", name, hashOf(key));
}

void write(const fs::path& file, std::string_view head, std::string_view text) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  fs::path draft = file;
  draft += fmt::format(".{}", ::getpid());
  std::ofstream out(draft, std::ios::binary);
  out << head << text;
  out.close();
  if (out) fs::rename(draft, file, ignored);
  if (!out || ignored) fs::remove(draft, ignored);
}

}  // namespace

fs::path cacheFolder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return fs::path(value == nullptr ? "" : value);
  };
  if (const fs::path chosen = variable("SK_CACHE"); !chosen.empty()) {
    return chosen == "off" ? fs::path() : chosen;
  }
  // a relative one is to be ignored: XDG Base Directory Specification
  if (const fs::path caches = variable("XDG_CACHE_HOME"); caches.is_absolute()) {
    return caches / "streamkernel";
  }
  const fs::path home = variable("HOME");
  return home.is_absolute() ? home / ".cache" / "streamkernel" : fs::path();
}

std::optional<std::string> readCached(std::string_view name, std::string_view key) {
  const fs::path folder = cacheFolder();
  if (folder.empty()) {
    return std::nullopt;
  }
  std::ifstream in(fileOf(folder, name, key), std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string head = headOf(key);
  return text.starts_with(head) ? std::optional(text.substr(head.size())) : std::nullopt;
}

void writeCached(std::string_view name, std::string_view key, std::string_view text) noexcept {
  try {
    if (const fs::path folder = cacheFolder(); !folder.empty()) {
      write(fileOf(folder, name, key), headOf(key), text);
    }
  } catch (const std::exception&) {
    return;  // it is measured again, then
  }
}

std::string driverKey(std::string_view renderer, std::string_view driver, std::string_view profile) {
  return fmt::format("StreamKernel {}, {}, {}, {}", SK_VERSION, renderer, driver, profile);
}

}  // namespace sk
