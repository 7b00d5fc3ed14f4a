// SPDX-License-Identifier: MIT
//
// Files that cannot be read or written, and threads that cannot be started: no call fails for them, all results are right, and
// nothing is left open or lying about.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include <unistd.h>

#include <catch2/catch.hpp>

#include "faults.hpp"
#include "faults.sk.hpp"
#include "sk/sk.hpp"

using namespace faults;

namespace {

namespace fs = std::filesystem;

class Folder {
 public:
  Folder() : path(fs::temp_directory_path() / ("sk_system_" + std::to_string(::getpid()))) {
    fs::create_directory(path);
    fs::permissions(path, fs::perms::owner_all);
    ::setenv("SK_CACHE", (path / "cache").c_str(), 1);
  }
  ~Folder() {
    ::setenv("SK_CACHE", "off", 1);
    fs::remove_all(path);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  /// Files that are no whole entries of the cache.
  std::ptrdiff_t drafts() const {
    std::ptrdiff_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(path)) {
      count += entry.path().filename().string().find('.') != std::string::npos ? 1 : 0;
    }
    return count;
  }

  /// Files here that this process has open. The driver's own cache has others, which its threads write when they like.
  std::ptrdiff_t openFiles() const {
    const std::string here = fs::canonical(path).string();
    std::ptrdiff_t count = 0;
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
      std::error_code closed;
      count += fs::read_symlink(entry.path(), closed).string().starts_with(here) ? 1 : 0;
    }
    return count;
  }

  const fs::path path;
};

std::vector<float> scaled(sk::Device& device, std::int64_t count) {
  auto x = device.stream<float>({count}), r = device.stream<float>({count});
  x.fill(3);
  faulty::scale(2.0F, x, r);
  return r.read();
}

}  // namespace

TEST_CASE("a cache folder on a disk that fails costs time and nothing else", "[system][file]") {
  const Folder folder;
  const std::vector<float> right(5, 6);
  const auto use = [&] {
    sk::Device device({.device = "gl", .profile = "glsl330", .doubles = "pairs"});
    static_cast<void>(device.arithmetic());  // is read from the cache, or written to it
    return scaled(device, 5);
  };
  for (const bool isFilled : {false, true}) {
    bool hasFired = true;
    long number = 1;
    for (; hasFired; ++number) {
      INFO((isFilled ? "filled " : "empty ") << number);
      REQUIRE(number < 500);
      if (!isFilled) fs::remove_all(folder.path / "cache");
      {
        const Fault fault(Kind::File, number);
        CHECK(use() == right);
        hasFired = fault.hasFired();
      }
      CHECK(folder.openFiles() == 0);
      CHECK(folder.drafts() == 0);
    }
    CHECK(number > 5);
    CHECK(use() == right);
  }
}

// A process of its own: its threads are started once. OMP_NUM_THREADS is 4.
TEST_CASE("a native device computes on the threads that there are", "[.threads]") {
  sk::Device device = sk::Device::native();
  constexpr std::int64_t count = 1 << 20;
  const std::vector<float> right(count, 6);
  for (long number = 1; number <= 3; ++number) {
    INFO(number);
    const long before = startedThreads();
    const Fault fault(Kind::Thread, 1);
    CHECK(scaled(device, count) == right);
    CHECK(fault.hasFired());
    CHECK(startedThreads() == before);
    std::this_thread::sleep_for(std::chrono::milliseconds(1050));  // then it tries again
  }
  const Fault fault(Kind::Thread, 2);
  CHECK(scaled(device, count) == right);
  CHECK(fault.hasFired());
  CHECK(startedThreads() == 1);
}
