// SPDX-License-Identifier: MIT
#include "support/cache_folder.hpp"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "skip.hpp"

using namespace sk;

namespace {

namespace fs = std::filesystem;

/// Sets an environment variable as long as this object lives.
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

/// A folder of this test's own, which does not exist yet.
class Folder {
 public:
  Folder() : path(fs::temp_directory_path() / ("sk_cache_" + std::to_string(::getpid()))) {}
  ~Folder() { fs::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path path;
};

/// The only file in a folder.
fs::path fileIn(const fs::path& folder) { return fs::directory_iterator(folder)->path(); }

std::ptrdiff_t filesIn(const fs::path& folder) { return std::distance(fs::directory_iterator(folder), {}); }

std::string textOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("what is kept comes back, for its key alone") {
  const Folder folder;
  const CacheFolder cache(folder.path);
  CHECK_FALSE(cache.read("barrier", "a driver").has_value());
  cache.write("barrier", "a driver", "precise\n");
  CHECK(cache.read("barrier", "a driver") == "precise\n");
  CHECK_FALSE(cache.read("barrier", "another driver").has_value());
  CHECK_FALSE(cache.read("info", "a driver").has_value());
  cache.write("barrier", "a driver", "xor\n");
  CHECK(cache.read("barrier", "a driver") == "xor\n");
  cache.write("empty", "a driver", "");
  CHECK(cache.read("empty", "a driver") == "");
  CHECK(filesIn(folder.path) == 2);
}

TEST_CASE("a folder that is missing is made, with those above it") {
  const Folder folder;
  const CacheFolder cache(folder.path / "above" / "it");
  cache.write("barrier", "a driver", "precise\n");
  CHECK(cache.read("barrier", "a driver") == "precise\n");
  CHECK(fs::status(folder.path / "above" / "it").permissions() == fs::perms::owner_all);
}

TEST_CASE("a file that is torn, changed or of somebody else's making is nothing") {
  const Folder folder;
  const CacheFolder cache(folder.path);
  cache.write("barrier", "a driver", "precise\n");
  const fs::path file = fileIn(folder.path);
  const std::string whole = textOf(file);
  const auto write = [&](const std::string& text) { std::ofstream(file, std::ios::binary) << text; };
  for (std::size_t length = 0; length < whole.size(); ++length) {
    write(whole.substr(0, length));
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
  }
  for (std::size_t at = 0; at < whole.size(); ++at) {
    std::string changed = whole;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    write(changed);
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
  }
  write(whole + "more");
  CHECK_FALSE(cache.read("barrier", "a driver").has_value());
  write(whole);
  CHECK(cache.read("barrier", "a driver") == "precise\n");
}

TEST_CASE("what is no file of the user's alone is not read, and stands in nobody's way") {
  const Folder folder;
  const CacheFolder cache(folder.path);
  cache.write("barrier", "a driver", "precise\n");
  const fs::path file = fileIn(folder.path);
  const std::string whole = textOf(file);
  SECTION("a directory") {
    fs::remove(file);
    fs::create_directory(file);
    fs::create_directory(file / "inside");
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
    cache.write("barrier", "a driver", "precise\n");
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
    CHECK(filesIn(folder.path) == 1);  // and no draft
  }
  SECTION("a link") {
    const fs::path elsewhere = folder.path / "elsewhere";
    fs::rename(file, elsewhere);
    fs::create_symlink(elsewhere, file);
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
    cache.write("barrier", "a driver", "xor\n");
    CHECK(cache.read("barrier", "a driver") == "xor\n");
    CHECK(textOf(elsewhere) == whole);
  }
  SECTION("a pipe, which nobody writes to") {
    fs::remove(file);
    REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
    cache.write("barrier", "a driver", "xor\n");
    CHECK(cache.read("barrier", "a driver") == "xor\n");
  }
  SECTION("a file that others may write") {
    fs::permissions(file, fs::perms::group_write, fs::perm_options::add);
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
    cache.write("barrier", "a driver", "precise\n");
    CHECK(cache.read("barrier", "a driver") == "precise\n");
  }
  SECTION("a file of another user") {
    if (::geteuid() != 0) {
      skip("only root can give a file to another user");
      return;
    }
    REQUIRE(::chown(file.c_str(), 12345, 12345) == 0);
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
  }
}

TEST_CASE("in a folder that others may write to, each user has one of his own") {
  const Folder folder;
  fs::create_directories(folder.path);
  fs::permissions(folder.path, fs::perms::all | fs::perms::sticky_bit);
  const CacheFolder cache(folder.path);
  cache.write("barrier", "a driver", "precise\n");
  CHECK(cache.read("barrier", "a driver") == "precise\n");
  const fs::path own = folder.path / std::to_string(::geteuid());
  CHECK(filesIn(folder.path) == 1);
  CHECK(fs::status(own).permissions() == fs::perms::owner_all);
  CHECK(fs::status(fileIn(own)).permissions() == (fs::perms::owner_read | fs::perms::owner_write));
  SECTION("unless somebody else has taken its place") {
    const fs::path elsewhere = folder.path / "elsewhere";
    fs::rename(own, elsewhere);
    fs::create_directory_symlink(elsewhere, own);
    CHECK_FALSE(cache.read("barrier", "a driver").has_value());
    cache.write("barrier", "another driver", "xor\n");
    CHECK(filesIn(elsewhere) == 1);
  }
}

TEST_CASE("a folder of another user is left alone") {
  if (::geteuid() != 0) {
    skip("only root can give a folder to another user");
    return;
  }
  const Folder folder;
  const CacheFolder cache(folder.path);
  cache.write("barrier", "a driver", "precise\n");
  REQUIRE(::chown(folder.path.c_str(), 12345, 12345) == 0);
  CHECK_FALSE(cache.read("barrier", "a driver").has_value());
  cache.write("barrier", "another driver", "xor\n");
  CHECK(filesIn(folder.path) == 1);
}

TEST_CASE("who writes at the same time leaves whole files") {
  const Folder folder;
  const CacheFolder cache(folder.path);
  const std::string one(100'000, '1'), two(200'000, '2');
  cache.write("program", "sources", one);
  bool isWhole = true;
  {
    std::jthread first([&] {
      for (int i = 0; i < 100; ++i) cache.write("program", "sources", one);
    });
    std::jthread second([&] {
      const CacheFolder other(folder.path);
      for (int i = 0; i < 100; ++i) other.write("program", "sources", two);
    });
    for (int i = 0; i < 100; ++i) {
      const std::optional<std::string> read = cache.read("program", "sources");
      isWhole = isWhole && (read == one || read == two);
    }
  }
  CHECK(isWhole);
  CHECK(filesIn(folder.path) == 1);
}

TEST_CASE("files are deleted when they are too many, the longest unused first") {
  const Folder folder;
  const CacheFolder roomy(folder.path);
  const auto now = fs::file_time_type::clock::now();
  int hoursAgo = 200;
  for (int i : {3, 4, 5, 6, 7, 8, 9, 0, 1, 2}) {  // beginning with the least recently used
    roomy.write("program", std::to_string(i), std::string(1000, 'x'));
    for (const auto& entry : fs::directory_iterator(folder.path)) {
      if (fs::last_write_time(entry.path()) > now - std::chrono::hours(1)) {
        fs::last_write_time(entry.path(), now - std::chrono::hours(hoursAgo--));
      }
    }
  }
  std::ofstream(folder.path / "notes.txt") << std::string(5000, 'x');  // the user's own file
  std::ofstream(folder.path / "program-0123456789abcdef.1.2.3.4f") << "a draft of a process that has ended";
  fs::last_write_time(folder.path / "program-0123456789abcdef.1.2.3.4f", now - std::chrono::hours(999));
  CHECK(roomy.read("program", "3").has_value());  // which counts as use
  CHECK(filesIn(folder.path) == 12);
  const CacheFolder tight(folder.path, 10'000);
  tight.write("barrier", "a driver",
              "precise\n");  // seven files of 1025 bytes are three quarters of that, with this one
  CHECK(filesIn(folder.path) == 9);
  CHECK(tight.read("program", "3").has_value());
  CHECK(tight.read("program", "2").has_value());
  CHECK_FALSE(tight.read("program", "4").has_value());
  CHECK(tight.read("barrier", "a driver").has_value());
  CHECK(fs::exists(folder.path / "notes.txt"));
  // their number stays bounded even if a single process writes all of them
  for (int i = 0; i < 100; ++i) tight.write("program", std::to_string(i), std::string(1000, 'y'));
  CHECK(filesIn(folder.path) < 14);
  tight.write("program", "huge", std::string(20'000, 'z'));
  CHECK_FALSE(tight.read("program", "huge").has_value());
}

TEST_CASE("files that the cache has not written are never deleted, whatever their names") {
  const Folder folder;
  fs::create_directory(folder.path);
  fs::permissions(folder.path, fs::perms::owner_all);
  const std::string names[] = {"photo-0123456789abcdef", "photo-0123456789abcdef.jpg",
                               "notes-0123456789abcdef.2.3", "program-0123456789abcdef"};
  for (const std::string& name : names) {
    std::ofstream(folder.path / name) << "StreamKernel\n0123456789abcdef 4000\n" << std::string(4000, 'x');
    fs::last_write_time(folder.path / name, fs::file_time_type::clock::now() - std::chrono::hours(999));
  }
  const CacheFolder tight(folder.path, 10'000);
  for (int i = 0; i < 30; ++i) tight.write("program", std::to_string(i), std::string(1000, 'y'));
  for (const std::string& name : names) CHECK(fs::exists(folder.path / name));
  CHECK(filesIn(folder.path) < 4 + 14);
  CHECK(tight.read("program", "29").has_value());
}

TEST_CASE("where nothing can be kept, nothing fails") {
  const CacheFolder cache("/proc/no/such/folder");
  cache.write("barrier", "a driver", "precise\n");
  CHECK_FALSE(cache.read("barrier", "a driver").has_value());
  const Folder folder;
  std::ofstream(folder.path) << "a file where the folder should be";
  const CacheFolder file(folder.path);
  file.write("barrier", "a driver", "precise\n");
  CHECK_FALSE(file.read("barrier", "a driver").has_value());
}

TEST_CASE("the environment is read once") {
  const Folder folder;
  const Variable before("SK_CACHE", folder.path);
  const CacheFolder cache;
  const Variable after("SK_CACHE", "off");
  cache.write("barrier", "a driver", "precise\n");
  CHECK(cache.read("barrier", "a driver") == "precise\n");
  CHECK(filesIn(folder.path) == 1);
}

TEST_CASE("the folder") {
  const Variable home("HOME", "/home/somebody");
  const Variable caches("XDG_CACHE_HOME", "/caches");
  {
    const Variable cache("SK_CACHE", "off");
    CHECK(CacheFolder().path().empty());
    CacheFolder().write("barrier", "a driver", "precise\n");
    CHECK_FALSE(CacheFolder().read("barrier", "a driver").has_value());
  }
  {
    const Variable cache("SK_CACHE", "elsewhere");
    CHECK(CacheFolder().path() == "elsewhere");
  }
  const Variable cache("SK_CACHE", "");
  CHECK(CacheFolder().path() == "/caches/streamkernel");
  const Variable relative("XDG_CACHE_HOME", "caches");
  CHECK(CacheFolder().path() == "/home/somebody/.cache/streamkernel");
  const Variable homeless("HOME", "");
  CHECK(CacheFolder().path().empty());
}
