// SPDX-License-Identifier: MIT
//
// A full disk, on which neither caches nor traces can be written: programs still run, and an error reports the trace once.
// A limit on the size of files stands in for the full disk.
#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "faults.hpp"
#include "faults.sk.hpp"
#include "scene.hpp"
#include "sk/sk.hpp"

using namespace faults;

namespace {

namespace fs = std::filesystem;

/// Sets an environment variable while it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { old_ ? setenv(name_, old_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> old_;
};

/// Keeps files from growing beyond a number of bytes.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit full{bytes, old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &full);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  void (*handler_)(int);
  rlimit old_{};
};

/// A folder for this test, removed at the end.
class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("sk_faults_" + std::to_string(::getpid()))) {
    fs::create_directory(path_);
    fs::permissions(path_, fs::perms::owner_all);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const char* name) const { return path_ / name; }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string textOf(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Calls every scenario. Returns the texts of errors of kind File, one per line; an error of another kind fails the test.
std::string callAll(sk::Device& device, bool isGl) {
  std::string told;
  Scene scene(device, 8);
  for (int round = 0; round < 2; ++round) {
    for (const Scenario& scenario : scenarios()) {
      if (scenario.needsGl && !isGl) continue;
      INFO(scenario.name);
      try {
        scene.reset();
        scenario.call(scene);
      } catch (const sk::Error& error) {
        CHECK(error.kind() == sk::Error::Kind::File);
        told += std::string(error.what()) + "\n";
      }
    }
  }
  return told;
}

}  // namespace

TEST_CASE("programs run without room for what is kept of them", "[disk]") {
  const Folder folder;
  const Variable cache("SK_CACHE", folder.path());
  const FullDisk full(64);
  sk::Device device({.device = "gl", .profile = "glsl330", .limits = "guaranteed", .doubles = "native"});
  CHECK(callAll(device, true) == "");
  CHECK(fs::is_empty(folder.path()));
}

TEST_CASE("a trace without room ends, and a call says so once", "[disk]") {
  const Folder folder;
  const std::string file = folder.file("trace.json");
  const Variable trace("SK_TRACE", file);
  for (const bool isGl : {false, true}) {
    fs::remove(file);
    const FullDisk full(40000);
    std::string told;
    {
      sk::Device device(sk::DeviceOptions{.device = isGl ? "gl" : "native", .textureLimit = isGl ? 64 : 0});
      told = callAll(device, isGl);
    }
    CHECK(told.find("cannot be written any more") != std::string::npos);
    CHECK(std::count(told.begin(), told.end(), '\n') == 1);
    const std::string text = textOf(file);
    CHECK(text.ends_with("}\n]}\n"));
    CHECK(text.size() > 1000);
  }
}

TEST_CASE("a trace that cannot begin is an error of the device", "[disk]") {
  const Folder folder;
  const std::string file = folder.file("trace.json");
  const Variable trace("SK_TRACE", file);
  const LiveObjects before = liveObjects();
  for (const char* name : {"native", "gl"}) {
    const FullDisk full(10);
    bool hasThrown = false;
    try {
      const sk::Device device{std::string_view(name)};
    } catch (const sk::Error& error) {
      hasThrown = true;
      CHECK(error.kind() == sk::Error::Kind::File);
      CHECK_THAT(error.what(), Catch::Contains("cannot be written"));
    }
    CHECK(hasThrown);
  }
  CHECK(liveObjects() == before);
}

TEST_CASE("a trace of the device's own times ends where its context is lost", "[disk][lost]") {
  const Folder folder;
  const std::string file = folder.file("trace.json");
  const Variable trace("SK_TRACE", file), clock("SK_TRACE_CLOCK", "timer");
  const LiveObjects before = liveObjects();
  bool hasFired = true;
  int queries = 0;
  for (long number = 1; hasFired; number += number < 20 ? 1 : 6) {
    INFO("call " << number);
    {
      sk::Device device(
          {.device = "gl", .profile = "glsl330", .textureLimit = 64});  // so that no copies are timed
      Scene scene(device, 8);
      device.finish();
      const Fault fault(Kind::Context, number);
      bool hasThrown = false;
      try {
        for (int i = 0; i < 2; ++i) {
          faulty::scale(2.0F, scene.x, scene.r);
          faulty::scale(2.0F, scene.r, scene.s);
        }
        device.finish();
      } catch (const sk::Error& error) {
        CHECK(error.kind() == sk::Error::Kind::Lost);
        hasThrown = true;
      }
      hasFired = fault.hasFired();
      CHECK(hasThrown == hasFired);
    }
    const std::string text = textOf(file);
    CHECK(text.ends_with("}\n]}\n"));
    queries += text.find("GL timer query") != std::string::npos ? 1 : 0;
  }
  CHECK(queries > 0);
  CHECK(liveObjects() == before);
}

TEST_CASE("a trace stays whole where memory is lacking", "[disk][host]") {
  const Folder folder;
  const std::string file = folder.file("trace.json");
  const Variable trace("SK_TRACE", file);
  {
    sk::Device device = sk::Device::native();
    Scene scene(device, 8);
    for (const Scenario& scenario : scenarios()) {
      bool hasFired = !scenario.needsGl;
      for (long number = 1; hasFired; ++number) {
        INFO(scenario.name << ": " << number);
        scene.reset();
        const Fault fault(Kind::Host, number);
        try {
          scenario.call(scene);
        } catch (const sk::Error& error) {
          CHECK(error.kind() == sk::Error::Kind::Memory);
        }
        hasFired = fault.hasFired();
      }
    }
  }
  const std::string text = textOf(file);
  CHECK(text.ends_with("}\n]}\n"));
  CHECK(text.find(",\n,") == std::string::npos);
  CHECK(text.find("}\n{") == std::string::npos);
  CHECK(text.find("\"threw\":true") != std::string::npos);
}
