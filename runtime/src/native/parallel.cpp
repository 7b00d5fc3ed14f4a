// SPDX-License-Identifier: MIT
#include "sk/native/parallel.hpp"

#include <algorithm>
#include <optional>

#include "native/thread_pool.hpp"
#include "support/checked_size.hpp"

namespace sk::native {

namespace {

/// The least work for a thread that is awake: as many elements of the simplest kernels as take some times as long as telling it.
constexpr std::int64_t worthAThread = 1 << 13;
/// Work that is worth waking threads that sleep.
constexpr std::int64_t worthWaking = 1 << 16;

/// The number of pieces of a loop. With many pieces, threads end at about the same time, and a thread that the system stops
/// holds little work. No piece is much shorter than what is worth a thread.
std::int64_t piecesOf(std::int64_t count, std::optional<std::int64_t> work, std::int64_t threads, Deal deal) {
  const bool isEven = deal == Deal::Evenly;
  const std::int64_t few = isEven ? 1 : 16, many = isEven ? 8 : 64;
  const std::int64_t leastWork = isEven ? 2 * worthAThread : worthAThread / 4;
  const std::int64_t worthIt = work ? *work / leastWork : many * threads;
  const std::int64_t pieces = std::clamp(worthIt, few * threads, many * threads);
  return std::min(count, isEven ? pieces / threads * threads : pieces);
}

}  // namespace

std::int64_t threadsFor(std::int64_t count, std::int64_t cost) {
  const std::optional<std::int64_t> work = checkedProduct(count, cost);
  const std::int64_t worthIt = work ? std::min(count, *work / worthAThread) : count;
  if (worthIt <= 1 || isInLoop()) return 1;
  return std::clamp<std::int64_t>(worthIt, 1, mostThreads());
}

void inParallel(std::int64_t count, std::int64_t cost, Deal deal, void (*work)(void*, Range), void* context) {
  const std::int64_t threads = threadsFor(count, cost);
  if (threads <= 1) {
    work(context, {0, count});
    return;
  }
  const std::optional<std::int64_t> total = checkedProduct(count, cost);
  const std::int64_t pieces = piecesOf(count, total, threads, deal);
  const std::int64_t shares = std::min<std::int64_t>({threads, pieces, SharedLoop::mostShares});
  SharedLoop loop(count, pieces, static_cast<int>(shares), work, context);
  runShared(loop, static_cast<int>(threads), !total || *total >= worthWaking);
}

}  // namespace sk::native
