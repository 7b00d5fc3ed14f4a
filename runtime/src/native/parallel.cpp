// SPDX-License-Identifier: MIT
//
// Parallel loops on OpenMP's threads, which the application's own loops share. Only this file uses OpenMP.
#include "sk/native/parallel.hpp"

#include <algorithm>
#include <exception>
#include <mutex>

#include "native/rest_threads.hpp"
#include "support/checked_size.hpp"

#if defined(_OPENMP)
#include <omp.h>
#endif
#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace sk::native {

#if defined(_OPENMP)

namespace {

/// True if this thread has started others here since the last restThreads(). Threads that the application
/// started are its own business.
thread_local bool haveThreads = false;

/// The least work for a thread: as many elements of the simplest kernels as take the time of waking it.
constexpr std::int64_t worthAThread = 1 << 13;

// OpenMP's library is built without ThreadSanitizer. These calls tell it that threads start after what
// precedes their loop, and end before what follows it.
#if defined(__SANITIZE_THREAD__)
#define SK_UNSEEN_BY_TSAN __attribute__((no_sanitize_thread))
void publish(void* to) { __tsan_release(to); }
void observe(void* from) { __tsan_acquire(from); }
#else
#define SK_UNSEEN_BY_TSAN
void publish(void*) {}
void observe(void*) {}
#endif

/// Keeps the last exception, because none may leave a thread.
class Guarded {
 public:
  Guarded(void (*work)(void*, Range), void* context) : work_(work), context_(context) { publish(&begun_); }

  void operator()(Range range) {
    observe(&begun_);
    try {
      work_(context_, range);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      thrown_ = std::current_exception();
    }
    publish(&done_);
  }
  void finish() {
    observe(&done_);
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  void (*work_)(void*, Range);
  void* context_;
  std::mutex mutex_;  ///< protects thrown_
  std::exception_ptr thrown_;
  char begun_ = 0, done_ = 0;  ///< their addresses represent start and end
};

/// Part `number` of `parts` almost equal parts.
Range partOf(std::int64_t count, std::int64_t number, std::int64_t parts) {
  return {count * number / parts, count * (number + 1) / parts};
}

/// The number of parts that threads take as they come: so many that all of them end at about the same time, of which none
/// is much shorter than what is worth a thread.
std::int64_t partsFor(std::int64_t count, std::int64_t cost, std::int64_t threads) {
  constexpr std::int64_t few = 16, many = 64;
  const std::optional<std::int64_t> work = checkedProduct(count, cost);
  const std::int64_t worthIt = work ? *work / (4 * worthAThread) : many * threads;
  return std::min(count, std::clamp(worthIt, few * threads, many * threads));
}

/// ThreadSanitizer does not check these loops either, because the compiler passes variables to threads in
/// memory.
SK_UNSEEN_BY_TSAN void runOnThreads(std::int64_t count, std::int64_t cost, int threads, Deal deal,
                                    Guarded& guarded) {
  if (deal == Deal::Evenly) {
#pragma omp parallel num_threads(threads)
    guarded(partOf(count, omp_get_thread_num(), omp_get_num_threads()));
  } else {
    const std::int64_t parts = partsFor(count, cost, threads);
#pragma omp parallel for schedule(dynamic) num_threads(threads)
    for (std::int64_t part = 0; part < parts; ++part) guarded(partOf(count, part, parts));
  }
}

}  // namespace

std::int64_t threadsFor(std::int64_t count, std::int64_t cost) {
  if (omp_in_parallel() != 0) return 1;
  const std::optional<std::int64_t> work = checkedProduct(count, cost);
  const std::int64_t worthIt = work ? std::min(count, *work / worthAThread) : count;
  return std::clamp<std::int64_t>(worthIt, 1, omp_get_max_threads());
}

void inParallel(std::int64_t count, std::int64_t cost, Deal deal, void (*work)(void*, Range), void* context) {
  const int threads = static_cast<int>(threadsFor(count, cost));
  if (threads <= 1) {
    work(context, {0, count});
    return;
  }
  haveThreads = true;
  Guarded guarded(work, context);
  runOnThreads(count, cost, threads, deal, guarded);
  guarded.finish();
}

void restThreads() {
  if (haveThreads) omp_pause_resource_all(omp_pause_soft);
  haveThreads = false;
}

#else

std::int64_t threadsFor(std::int64_t, std::int64_t) { return 1; }
void inParallel(std::int64_t count, std::int64_t, Deal, void (*work)(void*, Range), void* context) {
  work(context, {0, count});
}
void restThreads() {}

#endif

}  // namespace sk::native
