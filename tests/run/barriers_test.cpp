// SPDX-License-Identifier: MIT
//
// Promises: a device finds out by itself which barrier keeps rounding errors from its driver's compiler, and caches it. If no
// barrier does, calls that need one are rejected, and all others work.
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <optional>
#include <string>
#include <vector>

#include <unistd.h>

#include <catch2/catch.hpp>

#include "barriers.sk.hpp"
#include "sk/sk.hpp"

namespace {

namespace fs = std::filesystem;
using Catch::Contains;

/// 1, a million times 2^-25, -1: a plain sum of floats loses some of the small ones in any order.
constexpr std::size_t many = 1 << 20;
std::vector<float> cancelling() {
  std::vector<float> x(many + 2, 0x1p-25F);
  x.front() = 1;
  x.back() = -1;
  return x;
}

float compensatedSum(sk::Device& device) {
  auto x = device.stream<float>({static_cast<std::int64_t>(many + 2)});
  x.write(cancelling());
  return barriers::sum.with({.accumulate = sk::Accumulate::Compensated})(x);
}

sk::Device deviceOf(const std::string& profile, const std::string& barrier) {
  return sk::Device({.profile = profile, .doubles = "pairs", .barrier = barrier});
}

/// Sets SK_CACHE to an empty folder while it lives.
class Cache {
 public:
  Cache() : folder_(fs::temp_directory_path() / ("sk_barriers_" + std::to_string(::getpid()))) {
    if (const char* old = std::getenv("SK_CACHE")) old_ = old;
    ::setenv("SK_CACHE", folder_.c_str(), 1);
  }
  ~Cache() {
    fs::remove_all(folder_);
    old_ ? ::setenv("SK_CACHE", old_->c_str(), 1) : ::unsetenv("SK_CACHE");
  }
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

  bool hasFile() const { return fs::exists(folder_) && !files().empty(); }
  /// The folder's only file of barriers.
  fs::path file() const {
    REQUIRE(files().size() == 1);
    return files().front();
  }
  std::string lastLine() const {
    std::ifstream in(file());
    std::string line;
    while (in.peek() != EOF) std::getline(in, line);
    return line;
  }
  /// Replaces the text for the key. Updates the checksum (FNV-1a) if `isRight`, else keeps the old one.
  void replaceLastLine(const std::string& text, bool isRight) const {
    std::ifstream in(file());
    std::string key, checksum;
    std::getline(in, key);
    std::getline(in, checksum);
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
    std::ofstream out(file());
    out << key << '\n';
    if (isRight) {
      out << std::hex << std::setfill('0') << std::setw(16) << hash << std::dec << ' ' << text.size() << '\n';
    } else {
      out << checksum << '\n';
    }
    out << text;
  }

 private:
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      if (entry.path().filename().string().starts_with("barrier")) found.push_back(entry.path());
    }
    return found;
  }

  fs::path folder_;
  std::optional<std::string> old_;
};

TEST_CASE("every barrier that a device takes for good keeps sums exact") {
  for (const std::string profile : {"glsl330", "essl300", "essl310"}) {
    for (const std::string barrier : {"", "xor"}) {
      INFO(profile << " '" << barrier << "'");
      sk::Device device = deviceOf(profile, barrier);
      REQUIRE(device.arithmetic().exactSums);
      CHECK(device.arithmetic().barrier != sk::Barrier::None);
      CHECK(compensatedSum(device) == many * 0x1p-25F);
    }
  }
}

TEST_CASE("native code needs no barrier") {
  sk::Device device = sk::Device::native();
  CHECK(device.arithmetic().exactSums);
  CHECK(device.arithmetic().barrier == sk::Barrier::None);
  CHECK(device.driver().empty());
}

TEST_CASE("where no barrier holds, sums are plain, and compensated ones are refused") {
  for (const std::string profile : {"glsl330", "essl300"}) {
    sk::Device device = deviceOf(profile, "none");
    CHECK_FALSE(device.arithmetic().exactSums);
    auto x = device.stream<float>({static_cast<std::int64_t>(many + 2)});
    x.write(cancelling());
    CHECK_THROWS_WITH(compensatedSum(device),
                      Contains("barriers::sum: its sums cannot be compensated on '") &&
                          Contains("call it without Accumulate::Compensated"));
    const float plain = barriers::sum.with({.accumulate = sk::Accumulate::Tree})(x);
    CHECK(barriers::sum(x) == plain);
    auto total = device.stream<float>({1});
    barriers::sum(x, total);
    CHECK(total.read().front() == plain);
  }
}

TEST_CASE("where no barrier holds, doubles in pairs are refused, and nothing else is") {
  sk::Device device = deviceOf("essl300", "none");
  auto x = device.stream<double>({3});
  x.write(std::vector<double>{1, 2, 1e-300});
  CHECK(x.read() == std::vector<double>{1, 2, 1e-300});
  CHECK_THROWS_WITH(barriers::add(x, x, x), Contains("barriers::add: it computes with pairs of floats") &&
                                                Contains("SK_DEVICE=native"));
  CHECK_THROWS_WITH(barriers::sumDoubles(x), Contains("barriers::sumDoubles: it computes with pairs"));
  auto y = device.stream<float>({2});
  y.write(std::vector<float>{1, 2});
  barriers::twice(y, y);
  CHECK(y.read() == std::vector<float>{2, 4});
}

TEST_CASE("where no barrier holds, extended precision is refused") {
  for (const std::string profile : {"glsl330", "essl300"}) {
    sk::Device device({.profile = profile, .doubles = "pairs", .barrier = "none"});
    auto x = device.stream<float>({2});
    x.write(std::vector<float>{1, 2});
    const auto twice = barriers::twice.with({.precision = sk::Precision::Extended});
    CHECK_THROWS_WITH(twice(x, x), Contains("barriers::twice: it computes with pairs of floats"));
    const auto sum = barriers::sum.with({.accumulate = sk::Accumulate::Extended});
    CHECK_THROWS_WITH(sum(x), Contains("barriers::sum: it computes with pairs of floats"));
    auto total = device.stream<float>({1});
    CHECK_THROWS_WITH(sum(x, total), Contains("barriers::sum: it computes with pairs of floats"));
    CHECK(barriers::sum(x) == 3.0F);
  }
}

TEST_CASE("a barrier that there is not") {
  CHECK_THROWS_WITH(deviceOf("essl300", "precise"), Contains("has no `precise` in its ESSL 3.00"));
  CHECK_THROWS_WITH(deviceOf("glsl330", "fence"),
                    "there is no barrier 'fence'; choose precise, xor or none (option or SK_BARRIER)");
}

TEST_CASE("what was found out is remembered, and rubbish is not believed") {
  const Cache cache;
  const auto found = [](const char* profile) {
    return sk::Device({.profile = profile}).arithmetic().barrier;
  };
  REQUIRE(found("essl300") == sk::Barrier::Xor);
  CHECK(cache.lastLine() == "xor");
  for (const std::string rubbish : {"precise\n", "none\n", "xor xor\n", ""}) {  // ESSL 3.00 has no `precise`
    for (const bool isRight : {true, false}) {
      cache.replaceLastLine(rubbish, isRight);
      CHECK(found("essl300") == sk::Barrier::Xor);
      CHECK(cache.lastLine() == "xor");
    }
  }
  std::ofstream(cache.file()) << std::string(1000, '\xff');
  CHECK(found("essl300") == sk::Barrier::Xor);
  CHECK(cache.lastLine() == "xor");
}

TEST_CASE("what is remembered is not tried again") {
  const Cache cache;
  const auto found = [] { return sk::Device({.profile = "glsl330"}).arithmetic().barrier; };
  if (found() == sk::Barrier::Precise) {
    cache.replaceLastLine("xor\n", false);
    CHECK(found() == sk::Barrier::Precise);
    cache.replaceLastLine("xor\n", true);
    CHECK(found() == sk::Barrier::Xor);
  }
}

TEST_CASE("the trial is for those alone who need it") {
  const Cache cache;
  sk::Device device({.profile = "glsl330"});
  auto y = device.stream<float>({2});
  y.write(std::vector<float>{1, 2});
  barriers::twice(y, y);
  CHECK_FALSE(cache.hasFile());
  CHECK(barriers::sum(y) == 6.0F);
  CHECK(cache.hasFile());
}

}  // namespace
