// SPDX-License-Identifier: MIT
#include "cache_folder.hpp"

#include <cstdlib>
#include <fstream>
#include <string>

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
