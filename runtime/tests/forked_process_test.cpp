// SPDX-License-Identifier: MIT
//
// After fork(), the child cannot use devices with GL of its parent, nor open others: each use throws, none hangs, and handles may be
// destroyed. Native devices compute in both processes.
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

/// Runs a function in the child of a fork, which it must end within some seconds. Returns the numbers of checks that were false.
std::string wrongInChild(const std::function<std::vector<bool>()>& checks) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    alarm(20);  // if it hangs
    std::string wrong;
    const std::vector<bool> results = checks();
    for (std::size_t i = 0; i < results.size(); ++i) wrong += results[i] ? "" : " " + std::to_string(i);
    const bool isWritten = write(ends[1], wrong.data(), wrong.size()) == static_cast<ssize_t>(wrong.size());
    _exit(isWritten ? 0 : 1);
  }
  close(ends[1]);
  char text[256];
  const ssize_t count = read(ends[0], text, sizeof text);
  close(ends[0]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  return status == 0 ? std::string(text, static_cast<std::size_t>(count)) : "it has not ended by itself";
}

bool isRefused(const auto& use) {
  const std::string error = errorOf(use);
  return error.find("fork") != std::string::npos && error.find("native") != std::string::npos;
}

}  // namespace

#if !defined(__SANITIZE_THREAD__)  // which does not follow forks of programs with several threads
TEST_CASE("the child of a fork is refused its parent's device with GL, and destroys what belongs to it") {
  const TestKernel twice("twice", "void twice(float x, out float y) { y = 2.0 * x; }\n",
                         {input<float>("x"), output<float>("y")});
  auto device = std::make_unique<Device>("gl");
  auto x = device->stream<float>({100}), y = device->stream<float>({100});
  x.fill(1);
  twice(x, y);
  auto total = device->scalar<float>(2);
  Loop loop = device->record([&] { twice(x, y); });
  loop.repeat(3);
  auto early = std::make_unique<Future<float>>(y.readAsync());
  const std::string wrong = wrongInChild([&] {
    std::vector<bool> results = {
        isRefused([&] { (void)x.read(); }),
        isRefused([&] { x.fill(2); }),
        isRefused([&] { x.write(std::vector<float>(100)); }),
        isRefused([&] { x.copyTo(y); }),
        isRefused([&] { twice(x, y); }),
        isRefused([&] { loop.repeat(1); }),
        isRefused([&] { (void)(total + 1); }),
        isRefused([&] { total += 1; }),
        isRefused([&] { (void)total.read(); }),
        isRefused([&] { (void)early->get(); }),
        isRefused([&] { (void)device->stream<float>({5}); }),
        isRefused([&] { device->finish(); }),
        isRefused([&] { (void)device->availableMemory(); }),
        isRefused([&] { device->makeCurrent(); }),
        isRefused([] { Device("gl"); }),
        isRefused([] { (void)Device::adopt(); }),
        x.size() == 100,
        !device->name().empty(),
    };
    device->release();
    early.reset();
    loop = Loop();
    x = Stream<float>();
    device.reset();
    y = Stream<float>();
    Device native = Device::native();
    auto z = native.stream<float>({1000});
    z.fill(3);
    results.push_back(z.read() == std::vector<float>(1000, 3.0f));
    return results;
  });
  CHECK(wrong == "");
  CHECK(early->get() == std::vector<float>(100, 2.0f));  // the parent's device goes on
  CHECK(x.read() == std::vector<float>(100, 1.0f));
  CHECK(device->stream<float>({5}).size() == 5);
}
#endif
