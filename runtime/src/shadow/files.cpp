// SPDX-License-Identifier: MIT
#include "shadow/files.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

namespace sk::shadow {

std::string fileMark(const std::string& file) {
  struct stat status{};
  if (::stat(file.c_str(), &status) != 0) return {};
  return fmt::format("{} {} {} {}.{}", status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
                     status.st_mtim.tv_nsec);
}

namespace {

/// A name beside the file, which is not too long if the file's own name is not.
std::string temporaryName(const std::string& file) {
  constexpr std::size_t most = 200;
  const std::size_t slash = file.rfind('/');
  const std::size_t begin = slash == std::string::npos ? 0 : slash + 1;
  return fmt::format("{}{}.{}", file.substr(0, begin), file.substr(begin, most), ::getpid());
}

}  // namespace

std::string replaceFile(const std::string& file, std::string_view text) {
  const std::string temporary = temporaryName(file);
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) return fmt::format("cannot write '{}': {}", file, std::strerror(errno));
  int error = 0;
  while (!text.empty() && error == 0) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) error = errno;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && std::rename(temporary.c_str(), file.c_str()) != 0) error = errno;
  if (error == 0) return {};
  ::unlink(temporary.c_str());
  return fmt::format("cannot write '{}': {}", file, std::strerror(error));
}

std::string otherName(const std::string& name, const std::vector<std::string>& endings) {
  for (int number = 2;; ++number) {
    const std::string other = fmt::format("{}-{}", name, number);
    if (std::ranges::all_of(endings, [&](const auto& ending) { return fileMark(other + ending).empty(); }))
      return other;
  }
}

}  // namespace sk::shadow
