// SPDX-License-Identifier: MIT
//
// Parallel loops. The runtime implements them, so that a program with kernels needs no compiler option for
// threads.
#pragma once

#include <cstdint>
#include <memory>

namespace sk::native {

/// The numbers from `begin` (inclusive) to `end` (exclusive).
struct Range {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

/// How a loop is divided among threads.
enum class Deal : std::uint8_t {
  Evenly,  ///< each thread begins with neighbouring ranges, the same ones each time
  AsTheyCome,  ///< smaller ranges, to the next free thread
};

/// The most threads that inParallel would use: one if the loop is small, or runs inside another of ours or of OpenMP's.
std::int64_t threadsFor(std::int64_t count, std::int64_t cost);

/// Calls work(context, range) for ranges that partition the numbers below `count`, on several threads if
/// there is enough work. `cost` is the work per number, in elements or similar units. The caller's thread works on all ranges
/// itself, and others take some of them: it waits for none that has not begun. Rethrows an exception of `work`, after which
/// ranges that have not begun are left out, when all calls have ended.
void inParallel(std::int64_t count, std::int64_t cost, Deal deal, void (*work)(void*, Range), void* context);

template <class Work>
void inParallel(std::int64_t count, std::int64_t cost, Deal deal, Work&& work) {
  inParallel(
      count, cost, deal,
      [](void* context, Range range) { (*static_cast<std::remove_reference_t<Work>*>(context))(range); },
      std::addressof(work));
}

}  // namespace sk::native
