// SPDX-License-Identifier: MIT
//
// Threads that help others with their loops. Whoever has a loop works on it himself from its first piece to its last, and
// helpers take pieces of it while there are any. So a loop waits for no thread that has not begun, and for one that has, no
// longer than its piece takes: beside other busy processes, a call takes the time of the processors that it gets.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>

#include "sk/native/parallel.hpp"

namespace sk::native {

/// A loop whose pieces any thread may take. Each thread begins with pieces of its own share, which are the same ones each
/// time, and goes on with what is left of other shares.
class SharedLoop {
 public:
  static constexpr int mostShares = 64;

  /// `pieces` ranges of about equal length, in `shares` shares of which none is empty.
  SharedLoop(std::int64_t count, std::int64_t pieces, int shares, void (*work)(void*, Range, int),
             void* context);

  /// Works on pieces as the thread of this number, first on those of its share, until all have been taken.
  void workAs(int worker);
  /// Throws what a piece has thrown. To be called after all threads have left.
  void finish() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  /// On a line of a cache of its own.
  struct alignas(64) Share {
    std::atomic<std::int64_t> next;
    std::int64_t end;
  };

  void workOn(std::int64_t piece, int worker);

  std::int64_t count_, pieces_;
  int shares_;
  void (*work_)(void*, Range, int);
  void* context_;
  std::atomic<bool> hasThrown_ = false;  ///< pieces that nobody has taken are left out
  std::mutex mutex_;  ///< protects thrown_
  std::exception_ptr thrown_;
  std::array<Share, mostShares> share_;
};

/// The most threads that work on a loop at once, the caller's with them: what OpenMP says where the application uses it,
/// else what OMP_NUM_THREADS says, and never more than the available processors unless one of them asks for more.
int mostThreads();

/// True on a thread that works on a loop; its own loops stay on it.
bool isInLoop();

/// Works on a loop with up to `threads` - 1 helpers. Those that sleep are woken only if `mayWake`: that takes some
/// microseconds. Where threads cannot be started, there are fewer of them.
void runShared(SharedLoop& loop, int threads, bool mayWake);

}  // namespace sk::native
