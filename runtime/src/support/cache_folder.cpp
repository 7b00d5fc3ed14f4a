// SPDX-License-Identifier: MIT
//
// All operations are relative to an open folder that has been checked, so that nobody can replace it in the
// meantime.
#include "support/cache_folder.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

namespace sk {

namespace {

namespace fs = std::filesystem;

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  explicit operator bool() const { return number_ >= 0; }
  int get() const { return number_; }
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

constexpr mode_t othersMayWrite = S_IWGRP | S_IWOTH;

/// Whether the open file belongs to the user and nobody else may write to it.
bool isPrivate(const struct stat& status) {
  return status.st_uid == ::geteuid() && (status.st_mode & othersMayWrite) == 0;
}

std::optional<struct stat> statusOf(const Descriptor& file) {
  struct stat status{};
  if (!file || ::fstat(file.get(), &status) != 0) return std::nullopt;
  return status;
}

/// Opens the user's own folder: this one, or a subfolder of it if others may write to it.
Descriptor openFolder(const fs::path& path) {
  constexpr int flags = O_RDONLY | O_DIRECTORY | O_CLOEXEC;
  Descriptor folder(::open(path.c_str(), flags));
  std::optional<struct stat> status = statusOf(folder);
  if (!status || isPrivate(*status)) return folder;
  if ((status->st_mode & othersMayWrite) == 0) return Descriptor();
  const std::string own = std::to_string(::geteuid());
  ::mkdirat(folder.get(), own.c_str(), S_IRWXU);
  Descriptor inner(::openat(folder.get(), own.c_str(), flags | O_NOFOLLOW));
  status = statusOf(inner);
  return status && isPrivate(*status) ? std::move(inner) : Descriptor();
}

/// Parent folders get their default modes.
void makeFolder(const fs::path& path) {
  std::error_code ignored;
  fs::create_directories(path.parent_path(), ignored);
  ::mkdir(path.c_str(), S_IRWXU);
}

/// The file's header: a line with the key and a line with the checksum.
std::string headOf(std::string_view key, std::string_view text) {
  std::string head(key);
  for (char& c : head) {
    if (c == '\n') c = ' ';
  }
  return head + fmt::format("\n{:016x} {}\n", hashOf(text), text.size());
}

std::string nameOf(std::string_view name, std::string_view key) {
  return fmt::format("{}-{:016x}", name, hashOf(key));
}

bool areAll(std::string_view characters, std::string_view text) {
  return !text.empty() && text.find_first_not_of(characters) == std::string_view::npos;
}

constexpr std::string_view decimals = "0123456789", hexadecimals = "0123456789abcdef";

/// Whether the name is one that the cache may have given.
bool mayBeOurs(std::string_view name) {
  constexpr std::size_t digits = 16;
  const std::string_view stem = name.substr(0, name.find('.'));
  const std::size_t dash = stem.rfind('-');
  return dash != std::string_view::npos && stem.size() - dash - 1 == digits &&
         areAll(hexadecimals, stem.substr(dash + 1));
}

/// Whether the name is that of a draft (draftOf()), which may be torn.
bool isDraft(std::string_view name) {
  std::size_t parts = 0;
  std::size_t dot = name.find('.');
  for (; dot != std::string_view::npos; ++parts) {
    const std::size_t next = name.find('.', dot + 1);
    const bool isLast = next == std::string_view::npos;
    const std::string_view part = name.substr(dot + 1, isLast ? next : next - dot - 1);
    if (!areAll(isLast ? hexadecimals : decimals, part)) return false;
    dot = next;
  }
  return parts == 4;
}

/// Whether a file has a header that fits the rest of it.
bool hasHeader(std::string_view whole) {
  const std::size_t first = whole.find('\n');
  const std::size_t second = first == std::string_view::npos ? first : whole.find('\n', first + 1);
  if (second == std::string_view::npos) return false;
  return whole.starts_with(headOf(whole.substr(0, first), whole.substr(second + 1)));
}

bool writeAll(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::optional<std::string> contentsOf(int folder, const std::string& name, std::uintmax_t mostBytes) {
  // must neither block nor follow links
  Descriptor file(::openat(folder, name.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  const std::optional<struct stat> status = statusOf(file);
  if (!status || !S_ISREG(status->st_mode) || !isPrivate(*status)) return std::nullopt;
  const auto bytes = static_cast<std::uintmax_t>(status->st_size);
  if (bytes > mostBytes) return std::nullopt;
  std::string text(bytes, '\0');
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t got = ::read(file.get(), text.data() + at, text.size() - at);
    if (got <= 0) return std::nullopt;
    at += static_cast<std::size_t>(got);
  }
  return text;
}

/// Marks a file as used, once an hour.
void touch(int folder, const std::string& name) {
  struct stat status{};
  if (::fstatat(folder, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) != 0) return;
  constexpr time_t hour = 3600;
  if (::time(nullptr) - status.st_mtime > hour)
    ::utimensat(folder, name.c_str(), nullptr, AT_SYMLINK_NOFOLLOW);
}

/// A draft's name that is unique among processes, threads, machines and containers.
std::string draftOf(const std::string& name) {
  static std::atomic<unsigned> number = 0;
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  return fmt::format("{}.{}.{}.{}.{:x}", name, ::getpid(), ::gettid(), number++, now);
}

/// Writes to a draft first, so that nobody reads a partial file.
void replace(int folder, const std::string& name, std::string_view head, std::string_view text) {
  const std::string draft = draftOf(name);
  constexpr int flags = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW;
  Descriptor file(::openat(folder, draft.c_str(), flags, S_IRUSR | S_IWUSR));
  if (!file) return;
  bool isWhole = writeAll(file.get(), head) && writeAll(file.get(), text);
  isWhole = ::close(file.release()) == 0 && isWhole;
  isWhole = isWhole && ::renameat(folder, draft.c_str(), folder, name.c_str()) == 0;
  if (!isWhole) ::unlinkat(folder, draft.c_str(), 0);
}

struct File {
  std::string name;
  struct timespec used;
  std::uintmax_t bytes;
};

std::vector<File> filesIn(Descriptor folder) {
  std::vector<File> files;
  const std::unique_ptr<DIR, int (*)(DIR*)> list(::fdopendir(folder.get()), ::closedir);
  if (!list) return files;
  const int number = folder.release();  // the list closes it
  while (const dirent* entry = ::readdir(list.get())) {
    struct stat status{};
    if (!mayBeOurs(entry->d_name) || ::fstatat(number, entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0)
      continue;
    if (S_ISDIR(status.st_mode)) continue;
    files.push_back({entry->d_name, status.st_mtim, static_cast<std::uintmax_t>(status.st_size)});
  }
  return files;
}

/// If the files take more than `bytes`, deletes the least recently used ones until the rest take at most
/// three quarters of it. Other processes may delete the same files. The folder may be shared with other programs, whose files are
/// never deleted, whatever their names.
void bound(const fs::path& path, std::uintmax_t bytes) {
  const Descriptor folder = openFolder(path);
  std::vector<File> files = filesIn(openFolder(path));
  std::uintmax_t total = 0;
  for (const File& file : files) total += file.bytes;
  if (!folder || total <= bytes) return;
  std::ranges::sort(files, [](const File& a, const File& b) {
    return std::pair(a.used.tv_sec, a.used.tv_nsec) < std::pair(b.used.tv_sec, b.used.tv_nsec);
  });
  for (const File& file : files) {
    if (total <= bytes / 4 * 3) return;
    total -= file.bytes;
    const auto isCached = [&] {
      const std::optional<std::string> whole = contentsOf(folder.get(), file.name, bytes);
      return whole && hasHeader(*whole);
    };
    if (isDraft(file.name) || isCached()) ::unlinkat(folder.get(), file.name.c_str(), 0);
  }
}

fs::path chosenFolder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return fs::path(value == nullptr ? "" : value);
  };
  if (const fs::path chosen = variable("SK_CACHE"); !chosen.empty()) {
    return chosen == "off" ? fs::path() : chosen;
  }
  // relative paths must be ignored: XDG Base Directory Specification
  if (const fs::path caches = variable("XDG_CACHE_HOME"); caches.is_absolute()) {
    return caches / "streamkernel";
  }
  const fs::path home = variable("HOME");
  return home.is_absolute() ? home / ".cache" / "streamkernel" : fs::path();
}

}  // namespace

CacheFolder::CacheFolder() : CacheFolder(chosenFolder()) {}

std::optional<std::string> CacheFolder::read(std::string_view name, std::string_view key) const noexcept {
  if (path_.empty()) return std::nullopt;
  try {
    const Descriptor folder = openFolder(path_);
    const std::string file = nameOf(name, key);
    std::optional<std::string> whole = folder ? contentsOf(folder.get(), file, mostBytes_) : std::nullopt;
    if (!whole) return std::nullopt;
    const std::size_t firstLine = whole->find('\n');
    const std::size_t secondLine =
        firstLine == std::string::npos ? firstLine : whole->find('\n', firstLine + 1);
    if (secondLine == std::string::npos) return std::nullopt;
    const std::string_view text = std::string_view(*whole).substr(secondLine + 1);
    if (!whole->starts_with(headOf(key, text))) return std::nullopt;
    touch(folder.get(), file);
    return std::string(text);
  } catch (const std::exception&) {
    return std::nullopt;  // out of memory
  }
}

void CacheFolder::write(std::string_view name, std::string_view key, std::string_view text) const noexcept {
  if (path_.empty()) return;
  try {
    const std::string head = headOf(key, text);
    const std::uintmax_t bytes = head.size() + text.size();
    if (bytes > mostBytes_) return;
    makeFolder(path_);
    const Descriptor folder = openFolder(path_);
    if (!folder) return;
    replace(folder.get(), nameOf(name, key), head, text);
    // files are counted before the first write, and after each sixteenth of the limit
    if ((unchecked_ += bytes) > mostBytes_ / 16) {
      unchecked_ = 0;
      bound(path_, mostBytes_);
    }
  } catch (const std::exception&) {
    return;  // it is measured again
  }
}

double CacheFolder::measuredOnce(std::string_view name, std::string_view key,
                                 const std::function<double()>& measure) const {
  double number = 0;
  if (const std::optional<std::string> text = read(name, key)) {
    std::from_chars(text->data(), text->data() + text->size(), number);
  }
  if (number > 0 && std::isfinite(number)) return number;
  number = measure();
  if (number > 0) write(name, key, fmt::format("{:.4g}\n", number));
  return number;
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

std::string processorKey() {
  std::ifstream in("/proc/cpuinfo");
  std::string name;
  for (std::string line; name.empty() && std::getline(in, line);) {
    if (line.starts_with("model name")) name = line.substr(std::min(line.find(": "), line.size()));
  }
  return fmt::format("{} threads{}", std::thread::hardware_concurrency(), name);
}

}  // namespace sk
