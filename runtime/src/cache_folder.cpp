// SPDX-License-Identifier: MIT
//
// A file begins with its key, so that two keys of one hash do not meet and a person can read what it is of.
#include "cache_folder.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>
#include <vector>

#include <unistd.h>

#include <fmt/format.h>

namespace sk {

namespace {

namespace fs = std::filesystem;

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

std::optional<std::string> contentsOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) return std::nullopt;
  std::string text(static_cast<std::size_t>(std::max<std::streamoff>(in.tellg(), 0)), '\0');
  in.seekg(0).read(text.data(), static_cast<std::streamsize>(text.size()));
  return in ? std::optional(std::move(text)) : std::nullopt;
}

/// Notes that a file is in use, once an hour.
void touch(const fs::path& file) {
  std::error_code error;
  const auto now = fs::file_time_type::clock::now();
  const auto last = fs::last_write_time(file, error);
  if (!error && now - last > std::chrono::hours(1)) fs::last_write_time(file, now, error);
}

void write(const fs::path& file, std::string_view head, std::string_view text) {
  std::error_code ignored;
  fs::create_directories(file.parent_path(), ignored);
  fs::path draft = file;
  draft += fmt::format(".{}", ::gettid());
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
  const fs::path file = fileOf(folder, name, key);
  const std::optional<std::string> text = contentsOf(file);
  const std::string head = headOf(key);
  if (!text || !text->starts_with(head)) {
    return std::nullopt;
  }
  touch(file);
  return text->substr(head.size());
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

double measuredOnce(std::string_view name, std::string_view key, const std::function<double()>& measure) {
  double number = 0;
  if (const std::optional<std::string> text = readCached(name, key)) {
    std::from_chars(text->data(), text->data() + text->size(), number);
  }
  if (number > 0) return number;
  number = measure();
  if (number > 0) writeCached(name, key, fmt::format("{:.4g}\n", number));
  return number;
}

// Other processes may delete the same files.
void boundCached(std::string_view name, std::uintmax_t bytes) noexcept {
  struct File {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes;
  };
  try {
    std::vector<File> files;
    std::uintmax_t total = 0;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(cacheFolder(), error)) {
      if (!entry.path().filename().string().starts_with(fmt::format("{}-", name))) continue;
      const File file{entry.path(), entry.last_write_time(error), entry.file_size(error)};
      if (error) continue;
      total += files.emplace_back(file).bytes;
    }
    if (total <= bytes) return;
    std::ranges::sort(files, {}, &File::used);
    for (const File& file : files) {
      if (total <= bytes / 4 * 3) return;
      fs::remove(file.path, error);
      total -= file.bytes;
    }
  } catch (const std::exception&) {
    return;  // no memory, or no folder any more
  }
}

std::uint64_t hashOf(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  }
  return hash;
}

std::string driverKey(std::string_view renderer, std::string_view driver, std::string_view profile) {
  return fmt::format("StreamKernel {}, {}, {}, {}", SK_VERSION, renderer, driver, profile);
}

}  // namespace sk
