// SPDX-License-Identifier: MIT
//
// Programs of the shell that go past each limit.
#include "serve/limited_process.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <string>
#include <thread>

#include <catch2/catch.hpp>

namespace {

using sk_tool::ProcessLimits;
using sk_tool::ProcessResult;
using End = sk_tool::ProcessResult::End;

ProcessResult shell(const std::string& script, const ProcessLimits& limits = {}) {
  return sk_tool::runLimited({"/bin/sh", "-c", script}, limits);
}

}  // namespace

TEST_CASE("A program's streams and status are taken") {
  const ProcessResult result = shell("echo out; echo told >&2; cat; exit 3");
  CHECK(result.end == End::Exit);
  CHECK(result.status == 3);
  CHECK(result.output == "out\n");
  CHECK(result.messages == "told\n");
}

TEST_CASE("A program that is not there is not started") {
  CHECK(sk_tool::runLimited({"/no/such/program"}, {}).end == End::NotStarted);
}

TEST_CASE("A signal that ends a program is reported") {
  const ProcessResult result = shell("kill -SEGV $$");
  CHECK(result.end == End::Signal);
  CHECK(result.status == SIGSEGV);
}

TEST_CASE("A busy program ends after its CPU time") {
  CHECK(shell("while :; do :; done", {.cpuSeconds = 1}).end == End::Time);
}

TEST_CASE("A program that sleeps, and those that it has started, end after the wall time") {
  const ProcessResult result = shell("sleep 100 & sleep 100", {.wallTime = std::chrono::seconds(1)});
  CHECK(result.end == End::Time);
}

TEST_CASE("What a program has started ends with it") {
  // the other process has closed the streams, and tells its number first
  const ProcessResult result = shell("sleep 100 <&- >&- 2>&- & echo $!");
  CHECK(result.end == End::Exit);
  CHECK(result.status == 0);
  const pid_t started = std::stoi(result.output);
  // it is gone, or a zombie until init asks for it
  const auto isAlive = [&] {
    std::ifstream state("/proc/" + std::to_string(started) + "/stat");
    std::string number, name, letter;
    return state >> number >> name >> letter && letter != "Z";
  };
  for (int tries = 0; isAlive() && tries < 200; ++tries)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  CHECK_FALSE(isAlive());
}

TEST_CASE("A program that writes without end is stopped") {
  CHECK(shell("yes", {.output = 100'000}).end == End::Output);
  const char* file = "limited_process_test.out";
  CHECK(shell(std::string("exec head -c 1000000 /dev/zero > ") + file, {.file = 1000}).end == End::Output);
  std::remove(file);
}

TEST_CASE("A program gets no more memory than it may have") {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // dd allocates one block
  CHECK(shell("dd if=/dev/zero of=/dev/null bs=64M count=1", {}).status == 0);
  CHECK(shell("dd if=/dev/zero of=/dev/null bs=64M count=1", {.memory = std::size_t{32} << 20}).status != 0);
#endif
}
