// SPDX-License-Identifier: MIT
#include "sk/native/parallel.hpp"

#include <atomic>
#include <new>
#include <vector>

#include <catch2/catch.hpp>

#include "native/rest_threads.hpp"

namespace sk::native {
namespace {

constexpr std::int64_t costly = 1 << 20;  // each number is worth a thread

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

TEST_CASE("threads that rest are there again when they are needed") {
  for (int round = 0; round < 3; ++round) {
    std::atomic<std::int64_t> sum = 0;
    inParallel(100, costly, Deal::Evenly, [&](Range range) { sum += range.end - range.begin; });
    CHECK(sum == 100);
    restThreads();
    restThreads();
  }
}

TEST_CASE("what a thread throws arrives at the caller") {
  for (const Deal deal : {Deal::Evenly, Deal::AsTheyCome}) {
    CHECK_THROWS_AS(inParallel(64, costly, deal, [](Range) { throw std::bad_alloc(); }), std::bad_alloc);
  }
}

}  // namespace
}  // namespace sk::native
