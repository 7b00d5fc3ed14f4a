// SPDX-License-Identifier: MIT
#include "sk/native/parallel.hpp"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <new>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

namespace sk::native {
namespace {

constexpr std::int64_t costly = 1 << 20;  // each number is worth a thread
constexpr std::int64_t worthNoWaking = 1 << 13;

TEST_CASE("every number is worked on once, however it is dealt out") {
  for (const Deal deal : {Deal::Evenly, Deal::AsTheyCome}) {
    for (const std::int64_t count : {0, 1, 2, 7, 1000}) {
      std::vector<std::atomic<int>> times(static_cast<std::size_t>(count));
      inParallel(count, costly, deal, [&](Range range) {
        for (std::int64_t i = range.begin; i < range.end; ++i) ++times[static_cast<std::size_t>(i)];
      });
      for (const std::atomic<int>& n : times) CHECK(n == 1);
    }
  }
}

TEST_CASE("little work stays on the caller's thread, in one range") {
  int calls = 0;  // no other thread touches it
  inParallel(100, 1, Deal::Evenly, [&](Range range) {
    CHECK(range.begin == 0);
    CHECK(range.end == 100);
    ++calls;
  });
  CHECK(calls == 1);
}

TEST_CASE("a loop in a loop stays on its thread") {
  std::atomic<int> ranges = 0;
  inParallel(4, costly, Deal::Evenly, [&](Range outer) {
    for (std::int64_t i = outer.begin; i < outer.end; ++i) {
      CHECK(threadsFor(1000, costly) == 1);
      inParallel(1000, costly, Deal::AsTheyCome,
                 [&](Range range) { ranges += range.end == 1000 ? 1 : 1000; });
    }
  });
  CHECK(ranges == 4);
}

TEST_CASE("loops of several threads of an application run side by side") {
  std::vector<std::thread> threads;
  std::atomic<std::int64_t> sum = 0;
  for (int thread = 0; thread < 70; ++thread) {  // more than there are places for loops
    threads.emplace_back([&] {
      for (int round = 0; round < 20; ++round)
        inParallel(100, costly, round % 2 == 0 ? Deal::Evenly : Deal::AsTheyCome,
                   [&](Range range) { sum += range.end - range.begin; });
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(sum == 70 * 20 * 100);
}

TEST_CASE("a loop does not wait for helpers that sleep") {
  std::atomic<std::int64_t> sum = 0;
  for (int round = 0; round < 3; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // they have stopped to watch
    inParallel(2, worthNoWaking, Deal::Evenly, [&](Range range) { sum += range.end - range.begin; });
  }
  CHECK(sum == 6);
}

#if !defined(__SANITIZE_THREAD__)  // which does not follow forks of programs with several threads
TEST_CASE("the child of a fork computes, and starts helpers of its own") {
  inParallel(100, costly, Deal::Evenly, [](Range) {});
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    alarm(30);  // if it hangs
    std::atomic<std::int64_t> sum = 0;
    for (int round = 0; round < 50; ++round)
      inParallel(100, costly, Deal::Evenly, [&](Range range) { sum += range.end - range.begin; });
    _exit(sum == 5000 ? 0 : 1);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
}

TEST_CASE("the child of a fork within a loop ends that loop") {
  const std::thread::id caller = std::this_thread::get_id();
  pid_t child = -1;
  bool hasForked = false;
  inParallel(64, costly, Deal::Evenly, [&](Range) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that all threads get pieces
    if (std::this_thread::get_id() != caller || hasForked) return;
    hasForked = true;
    child = fork();
    if (child == 0) alarm(30);  // if it hangs
  });
  REQUIRE(child >= 0);
  if (child == 0) _exit(0);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
}

/// The number of threads that some loops have run on.
std::size_t threadsSeen() {
  std::mutex mutex;
  std::set<std::thread::id> seen;
  for (int round = 0; round < 20; ++round) {
    inParallel(64, costly, Deal::AsTheyCome, [&](Range) {
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
      std::this_thread::sleep_for(std::chrono::microseconds(20));
    });
  }
  return seen.size();
}

TEST_CASE("the environment, masks of processors and missing threads bound the threads of a loop") {
  // Limits are read once, so that each case is a process of its own.
  const char* const cases[] = {"one thread", "three threads", "one processor", "no threads",
                               "an end within a loop"};
  for (const char* name : cases) {
    CAPTURE(name);
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      alarm(60);
      setenv("OMP_NUM_THREADS", name == cases[0] ? "1" : name == cases[1] ? "3,2" : "64", 1);
      if (name == cases[2]) unsetenv("OMP_NUM_THREADS");
      execl("/proc/self/exe", "parallel", name, static_cast<char*>(nullptr));
      _exit(9);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(status == 0);
  }
}

/// Another thread's loop goes on while the process ends, and ends itself after the helpers have.
TEST_CASE("an end within a loop", "[.]") {
  std::atexit([] { std::this_thread::sleep_for(std::chrono::milliseconds(200)); });
  std::thread([] {
    inParallel(64, costly, Deal::Evenly, [](Range range) {
      std::this_thread::sleep_for(std::chrono::milliseconds(range.begin == 0 ? 100 : 1));
    });
  }).detach();
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
}
TEST_CASE("one thread", "[.]") { CHECK(threadsSeen() == 1); }
TEST_CASE("three threads", "[.]") { CHECK(threadsSeen() <= 3); }
TEST_CASE("one processor", "[.]") {
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(sched_getcpu()), &one);
  REQUIRE(sched_setaffinity(0, sizeof one, &one) == 0);
  CHECK(threadsSeen() == 1);
}
TEST_CASE("no threads", "[.]") {
  rlimit memory{};
  REQUIRE(getrlimit(RLIMIT_AS, &memory) == 0);
  const rlimit none{1 << 20, memory.rlim_max};  // no room for the stack of another thread
  REQUIRE(setrlimit(RLIMIT_AS, &none) == 0);
  std::atomic<std::int64_t> sum = 0;
  inParallel(100, costly, Deal::Evenly, [&](Range range) { sum += range.end - range.begin; });
  REQUIRE(setrlimit(RLIMIT_AS, &memory) == 0);
  CHECK(sum == 100);
}
#endif

TEST_CASE("what a thread throws arrives at the caller") {
  for (const Deal deal : {Deal::Evenly, Deal::AsTheyCome}) {
    CHECK_THROWS_AS(inParallel(64, costly, deal, [](Range) { throw std::bad_alloc(); }), std::bad_alloc);
  }
}

}  // namespace
}  // namespace sk::native
