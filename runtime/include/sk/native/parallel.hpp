// SPDX-License-Identifier: MIT
//
// Parallel loops. The runtime implements them, so that a program with kernels needs no compiler option for
// threads.
#pragma once

#include <cstdint>
#include <memory>
#include <type_traits>

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

/// Calls work(context, range, worker) for ranges that partition the numbers below `count`, on several threads if there is
/// enough work. `cost` is the work per number, in elements or similar units. The caller's thread works on all ranges itself,
/// and others take some of them: it waits for none that has not begun. `worker` is the number of the thread in this loop,
/// below threadsFor(count, cost). Rethrows an exception of `work`, after which ranges that have not begun are left out, when
/// all calls have ended.
void inParallel(std::int64_t count, std::int64_t cost, Deal deal,
                void (*work)(void* context, Range range, int worker), void* context);

/// Likewise calls work(range), or work(range, worker).
template <class Work>
void inParallel(std::int64_t count, std::int64_t cost, Deal deal, Work&& work) {
  using Called = std::remove_reference_t<Work>;
  inParallel(
      count, cost, deal,
      [](void* context, Range range, [[maybe_unused]] int worker) {
        if constexpr (std::is_invocable_v<Called&, Range, int>) {
          (*static_cast<Called*>(context))(range, worker);
        } else {
          (*static_cast<Called*>(context))(range);
        }
      },
      const_cast<void*>(static_cast<const void*>(std::addressof(work))));
}

}  // namespace sk::native
