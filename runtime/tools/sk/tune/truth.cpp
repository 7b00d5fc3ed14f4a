// SPDX-License-Identifier: MIT
#include "tune/truth.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

#include <unistd.h>

#include <fmt/format.h>

#include "support/cache_folder.hpp"

namespace sk_tool::tune {

namespace {

namespace fs = std::filesystem;

/// Larger results are computed anew each time.
constexpr std::size_t mostCachedBytes = std::size_t{16} << 20;

/// Variables that differ between terminals and sessions, which no result depends on; SK_DEVICE is the reference's, which has no configuration.
bool isVolatile(std::string_view variable) {
  constexpr std::array names = {"_=",       "SHLVL=",     "OLDPWD=",     "PS1=",       "LINES=",
                                "COLUMNS=", "SK_DEVICE=", "SK_RESULTS=", "SK_CONFIG=", "SK_CACHE=",
                                "TMPDIR=",  "WINDOWID=",  "DISPLAY=",    "SSH_",       "XDG_SESSION_",
                                "TERM",     "COLORTERM="};
  return std::ranges::any_of(names, [&](const char* name) { return variable.starts_with(name); });
}

/// The contents of a file, as a number; those of very large files by their size and time.
std::string contentsOf(const fs::path& file) {
  constexpr std::uintmax_t most = std::uintmax_t{256} << 20;
  const std::uintmax_t size = fs::file_size(file);
  if (size > most) return fmt::format("{} {}", size, fs::last_write_time(file).time_since_epoch().count());
  std::ifstream in(file, std::ios::binary);
  return fmt::format("{} {:016x}", size, sk::hashOf(std::string(std::istreambuf_iterator<char>(in), {})));
}

/// The file of this name, or of a program that is found as execvp finds it; nullopt if there is none.
std::optional<fs::path> fileOfProgram(const std::string& name) {
  std::error_code error;
  if (fs::exists(name, error)) return name;
  if (name.find('/') != std::string::npos) return std::nullopt;
  const char* const path = std::getenv("PATH");
  std::string rest = path == nullptr ? "/usr/bin:/bin" : path;
  while (!rest.empty()) {
    const std::size_t end = rest.find(':');
    const fs::path file = fs::path(rest.substr(0, end)) / name;
    if (::access(file.c_str(), X_OK) == 0) return file;
    rest = end == std::string::npos ? "" : rest.substr(end + 1);
  }
  return std::nullopt;
}

/// The words of a word, which may be a command line for the shell, without quotes.
std::vector<std::string> partsOf(const std::string& word) {
  std::vector<std::string> parts(1);
  for (const char c : word) {
    if (c == '\'' || c == '"') continue;
    if (std::isspace(static_cast<unsigned char>(c)) != 0 || c == ';') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  std::erase(parts, "");
  return parts;
}

std::string keyOf(const Application& application) {
  std::string key = fmt::format("{}\n", fs::current_path().string());
  for (const std::string& word : application.words()) {
    key += word + '\n';
    for (const std::string& part : partsOf(word)) {
      std::error_code error;
      const std::optional<fs::path> file = fileOfProgram(part);
      if (file && fs::is_regular_file(*file, error)) key += fmt::format("{} {}\n", part, contentsOf(*file));
    }
  }
  for (const ResultFile& file : application.files()) key += file.name() + '\n';
  std::vector<std::string> variables;
  for (char** each = environ; *each != nullptr; ++each) {
    if (!isVolatile(*each)) variables.emplace_back(*each);
  }
  std::ranges::sort(variables);
  for (const std::string& variable : variables) key += variable + '\n';
  return key;
}

void checkReference(const Application& application, const sk::results::Process& process) {
  for (const sk::results::Kernel& kernel : process.kernels) {
    if (kernel.isOnReference) continue;
    throw std::runtime_error(fmt::format(
        "{} runs {} on '{}' even with SK_DEVICE=reference, so that its right results are unknown; let it "
        "open its devices without a name (sk::Device device;)",
        application.name(), kernel.name, kernel.device));
  }
}

}  // namespace

Truth truthOf(const Application& application, bool isFresh) {
  const sk::CacheFolder cache;
  const std::string key = keyOf(application);
  if (const auto known = isFresh ? std::nullopt : cache.read("truth", key)) {
    try {
      return {.process = sk::results::fromBytes(*known, "truth"), .isCached = true};
    } catch (const std::runtime_error&) {
      // of another version of StreamKernel: computed anew
    }
  }
  RunResult result =
      application.run({.environment = {{"SK_DEVICE", "reference"}, {"SK_CONFIG", std::nullopt}}});
  if (!result.failure.empty()) {
    throw std::runtime_error(
        fmt::format("{} does not run on the reference device, whose results are the truth: it {}",
                    application.name(), result.failure));
  }
  checkReference(application, result.process);
  if (const std::string bytes = sk::results::toBytes(result.process); bytes.size() <= mostCachedBytes)
    cache.write("truth", key, bytes);
  return {.process = std::move(result.process), .isCached = false, .wall = result.wall};
}

}  // namespace sk_tool::tune
