// SPDX-License-Identifier: MIT
#include "cache_folder.hpp"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include <unistd.h>

#include <catch2/catch.hpp>

using namespace sk;

namespace {

namespace fs = std::filesystem;

/// A variable of the environment for as long as this lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    ::setenv(name, value.c_str(), 1);
  }
  ~Variable() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

/// A folder of this test's own that does not exist yet.
class Folder {
 public:
  Folder() : path(fs::temp_directory_path() / ("sk_cache_" + std::to_string(::getpid()))) {}
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path path;
};

}  // namespace

TEST_CASE("what is kept comes back, for its key alone") {
  const Folder folder;
  const Variable cache("SK_CACHE", folder.path);
  CHECK_FALSE(readCached("barrier", "a driver").has_value());
  writeCached("barrier", "a driver", "precise\n");
  CHECK(readCached("barrier", "a driver") == "precise\n");
  CHECK_FALSE(readCached("barrier", "another driver").has_value());
  CHECK_FALSE(readCached("info", "a driver").has_value());
  writeCached("barrier", "a driver", "xor\n");
  CHECK(readCached("barrier", "a driver") == "xor\n");
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("a file that somebody else wrote is nothing") {
  const Folder folder;
  const Variable cache("SK_CACHE", folder.path);
  writeCached("barrier", "a driver", "precise\n");
  std::ofstream(fs::directory_iterator(folder.path)->path()) << "rubbish";
  CHECK_FALSE(readCached("barrier", "a driver").has_value());
}

TEST_CASE("who writes at the same time leaves whole files") {
  const Folder folder;
  const Variable cache("SK_CACHE", folder.path);
  const std::string one(100'000, '1'), two(200'000, '2');
  writeCached("program", "sources", one);
  bool isWhole = true;
  {
    std::jthread first([&] {
      for (int i = 0; i < 100; ++i) writeCached("program", "sources", one);
    });
    std::jthread second([&] {
      for (int i = 0; i < 100; ++i) writeCached("program", "sources", two);
    });
    for (int i = 0; i < 100; ++i) {
      const std::optional<std::string> read = readCached("program", "sources");
      isWhole = isWhole && (read == one || read == two);
    }
  }
  CHECK(isWhole);
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 1);
}

TEST_CASE("files of a name are deleted when they are too many, the longest unused first") {
  const Folder folder;
  const Variable cache("SK_CACHE", folder.path);
  writeCached("barrier", "a driver", "precise\n");
  for (int i = 0; i < 10; ++i) {
    writeCached("program", std::to_string(i), std::string(1000, 'x'));
  }
  const auto now = fs::file_time_type::clock::now();
  int order = 0;
  for (int i : {3, 4, 5, 6, 7, 8, 9, 0, 1, 2}) {  // from the longest unused on
    for (const auto& entry : fs::directory_iterator(folder.path)) {
      std::ifstream in(entry.path());
      std::string key;
      std::getline(in, key);
      if (key == std::to_string(i)) fs::last_write_time(entry.path(), now - std::chrono::hours(200 - order));
    }
    ++order;
  }
  CHECK(readCached("program", "3").has_value());  // which is used thereby
  boundCached("program", 20'000);
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 11);
  boundCached("program", 8'100);  // three quarters hold six files of 1002 bytes
  CHECK(std::distance(fs::directory_iterator(folder.path), {}) == 7);
  CHECK(readCached("program", "3").has_value());
  CHECK(readCached("program", "2").has_value());
  CHECK_FALSE(readCached("program", "4").has_value());
  CHECK(readCached("barrier", "a driver").has_value());
  boundCached("nothing", 0);
}

TEST_CASE("where nothing can be kept, nothing fails") {
  const Variable cache("SK_CACHE", "/proc/no/such/folder");
  writeCached("barrier", "a driver", "precise\n");
  CHECK_FALSE(readCached("barrier", "a driver").has_value());
}

TEST_CASE("the folder") {
  const Variable home("HOME", "/home/somebody");
  const Variable caches("XDG_CACHE_HOME", "/caches");
  {
    const Variable cache("SK_CACHE", "off");
    CHECK(cacheFolder().empty());
    writeCached("barrier", "a driver", "precise\n");
  }
  {
    const Variable cache("SK_CACHE", "elsewhere");
    CHECK(cacheFolder() == "elsewhere");
  }
  const Variable cache("SK_CACHE", "");
  CHECK(cacheFolder() == "/caches/streamkernel");
  const Variable relative("XDG_CACHE_HOME", "caches");
  CHECK(cacheFolder() == "/home/somebody/.cache/streamkernel");
  const Variable homeless("HOME", "");
  CHECK(cacheFolder().empty());
}
