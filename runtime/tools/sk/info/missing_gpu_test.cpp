// SPDX-License-Identifier: MIT
//
// Describes machines by a few files each, and tests the diagnosis for them.
#include "info/missing_gpu.hpp"

#include <fstream>
#include <set>

#include <catch2/catch.hpp>

namespace {

namespace fs = std::filesystem;
using Catch::Contains;

class TestMachine {
 public:
  TestMachine() : root_(fs::temp_directory_path() / "sk_missing_gpu_test") {
    fs::remove_all(root_);
    fs::create_directories(root_ / "dev");
  }
  ~TestMachine() { fs::remove_all(root_); }
  TestMachine(const TestMachine&) = delete;
  TestMachine& operator=(const TestMachine&) = delete;

  void put(const std::string& file, const std::string& text = {}) {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text << '\n';
  }
  void putDisplay(const std::string& vendor) {
    put("sys/bus/pci/devices/0000:01:00.0/class", "0x030000");
    put("sys/bus/pci/devices/0000:01:00.0/vendor", vendor);
  }
  std::string why() const {
    return sk_tool::whyNoGpu({.root = root_,
                              .canLoad = [&](const std::string& name) { return libraries.contains(name); },
                              .mayUse = [&](const fs::path&) { return hasRights; }});
  }

  std::set<std::string> libraries{"libEGL.so.1"};
  bool hasRights = true;

 private:
  fs::path root_;
};

}  // namespace

TEST_CASE("a machine without a GPU is told what is missing") {
  TestMachine machine;
  SECTION("EGL") {
    machine.libraries.clear();
    CHECK_THAT(machine.why(), Contains("libEGL.so.1") && Contains("apt-get install libegl1"));
  }
  SECTION("hardware") {
    CHECK_THAT(machine.why(), Contains("no display controller") && Contains("passed on"));
  }
  SECTION("a driver for 3D") {
    machine.putDisplay("0x1234");
    CHECK_THAT(machine.why(), Contains("no /dev/dri/renderD128"));
  }
  SECTION("rights") {
    machine.putDisplay("0x8086");
    machine.put("dev/dri/renderD128");
    machine.hasRights = false;
    CHECK_THAT(machine.why(), Contains("no rights on /dev/dri/renderD128") && Contains("usermod"));
  }
  SECTION("a usable driver") {
    machine.put("dev/dri/renderD128");
    CHECK_THAT(machine.why(), Contains("SK_DEVICE=gpu"));
  }
  SECTION("NVIDIA's kernel driver") {
    machine.putDisplay("0x10de");
    CHECK_THAT(machine.why(), Contains("no /dev/nvidia0"));
  }
  SECTION("NVIDIA's library") {
    machine.put("dev/nvidia0");
    CHECK_THAT(machine.why(), Contains("libEGL_nvidia.so.0"));
  }
}
