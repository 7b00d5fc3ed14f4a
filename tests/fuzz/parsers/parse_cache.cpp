// SPDX-License-Identifier: MIT
//
// Files of the cache folder. The first byte decides whether the rest is a whole file, or the contents of a file with the right
// key and checksum, which should be a measured number.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

#include "parsers/entry.hpp"
#include "support/cache_folder.hpp"

namespace {

namespace fs = std::filesystem;

constexpr std::string_view key = "a driver";

class Folder {
 public:
  Folder()
      : path_(fs::temp_directory_path() / ("sk_fuzz_cache_" + std::to_string(::getpid()))), cache(path_) {
    cache.write("bandwidth", key, "");
    file_ = fs::directory_iterator(path_)->path();
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void hold(std::string_view bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }

 private:
  fs::path path_, file_;

 public:
  const sk::CacheFolder cache;
};

void tryWhole(const Folder& folder, std::string_view file) {
  folder.hold(file);
  const std::optional<std::string> text = folder.cache.read("bandwidth", key);
  if (text && !(file.starts_with(key) && file.ends_with(*text))) std::abort();
}

void tryNumber(const Folder& folder, std::string_view text) {
  folder.cache.write("bandwidth", key, text);
  if (folder.cache.read("bandwidth", key) != text) std::abort();
  const double number = folder.cache.measuredOnce("bandwidth", key, [] { return 7.0; });
  if (!std::isfinite(number) || number <= 0) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  if (size == 0) return 0;
  const std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  data[0] % 2 == 0 ? tryWhole(folder, rest) : tryNumber(folder, rest);
  return 0;
}
