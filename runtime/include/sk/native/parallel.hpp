// SPDX-License-Identifier: MIT
//
// Loops on the threads of the machine. The runtime has them, so that a program with kernels needs no option of its compiler for it.
#pragma once

#include <cstdint>
#include <memory>

namespace sk::native {

/// Numbers from `begin` to `end`.
struct Range {
  std::int64_t begin = 0;
  std::int64_t end = 0;
};

/// How work is dealt out.
enum class Deal : std::uint8_t {
  Evenly,  ///< each thread gets one run of neighbours, the same ones each time
  AsTheyCome,  ///< small runs, to whoever is free
};

/// Threads that inParallel would run such a loop on: one where it is small, or where another loop of ours runs it.
std::int64_t threadsFor(std::int64_t count, std::int64_t cost);

/// work(context, range) for ranges that together are all numbers below `count`, on several threads where there is enough to do.
/// `cost` is what a number takes, in elements or their like. What a call throws is thrown here, after all have ended.
void inParallel(std::int64_t count, std::int64_t cost, Deal deal, void (*work)(void*, Range), void* context);

template <class Work>
void inParallel(std::int64_t count, std::int64_t cost, Deal deal, Work&& work) {
  inParallel(
      count, cost, deal,
      [](void* context, Range range) { (*static_cast<std::remove_reference_t<Work>*>(context))(range); },
      std::addressof(work));
}

}  // namespace sk::native
