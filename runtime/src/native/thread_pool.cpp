// SPDX-License-Identifier: MIT
//
// Also implements sk/native/parallel.hpp: how many threads a loop takes, and in how many pieces.

#include "native/thread_pool.hpp"

#include <pthread.h>
#include <signal.h>
#include <algorithm>
#include <bit>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "sk/native/parallel.hpp"
#include "support/checked_size.hpp"
#include "support/host_limits.hpp"

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

// There if the application uses OpenMP.
extern "C" {
__attribute__((weak)) int omp_get_max_threads();
__attribute__((weak)) int omp_in_parallel();
}

namespace sk::native {

namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::microseconds;

/// True while this thread works on pieces.
thread_local bool inLoop = false;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Watches for `isThere` for some time. Returns whether it came.
template <class Predicate>
bool watch(std::chrono::nanoseconds time, Predicate&& isThere) {
  const Clock::time_point end = Clock::now() + time;
  do {
    for (int i = 0; i < 16; ++i) {
      if (isThere()) return true;
      pause();
    }
  } while (Clock::now() < end);
  return false;
}

/// The first number of OMP_NUM_THREADS; 0 if it says nothing.
int wantedThreads() {
  const char* const text = std::getenv("OMP_NUM_THREADS");
  if (text == nullptr) return 0;
  std::string_view list = text;
  list.remove_prefix(std::min(list.find_first_not_of(" \t"), list.size()));
  int number = 0;
  const auto [end, error] = std::from_chars(list.data(), list.data() + list.size(), number);
  const bool isNumber =
      error == std::errc() && (end == list.data() + list.size() || *end == ',' || *end == ' ');
  return isNumber && number > 0 ? std::min(number, 4096) : 0;
}

bool isPassive() {
  const char* const policy = std::getenv("OMP_WAIT_POLICY");
  return policy != nullptr && (*policy == 'p' || *policy == 'P');
}

/// What does not change while a process runs.
struct Limits {
  int wanted = wantedThreads();
  int processors = availableProcessors();
  bool watches = !isPassive();
};
const Limits& limits() {
  static const Limits all;
  return all;
}

/// A place for a loop that helpers can find. Places live as long as the process, so that a helper may look at one whose loop
/// has ended.
struct alignas(64) Place {
  std::atomic<int> threads = 0;  ///< helpers with numbers below this may help
  SharedLoop* loop = nullptr;  ///< read by helpers that have said where they are and then found it open
};

/// A thread that helps. It says where it is on a line of a cache of its own, so that threads that begin and end at the same time do
/// not wait for each other's writes.
struct alignas(64) Helper {
  /// 1 more than the number of the place whose loop it looks at or works on; 0: none.
  std::atomic<std::uint32_t> at = 0;
  std::atomic<std::uint32_t> sleeps = 0;
  std::thread thread;
};

class Helpers {
 public:
  void run(SharedLoop& loop, int threads, bool mayWake) {
    start(threads - 1);
    const int number = takePlace();
    if (number < 0) return loop.workAs(0);  // as many loops as places run already
    Place& place = places_[number];
    const std::uint64_t bit = std::uint64_t{1} << number;
    place.loop = &loop;
    const int most = std::min(threads, 1 + started_.load());
    place.threads.store(most);
    open_.fetch_or(bit);
    if (mayWake) wakeBelow(0, place);
    loop.workAs(0);
    if ((open_.load() & bit) != 0) open_.fetch_and(~bit);
    // Helpers say that they are there before they look whether it is open, so that none comes after this.
    const auto here = static_cast<std::uint32_t>(number + 1);
    for (int i = 1; i < most && i <= started_.load(); ++i) {
      Helper& helper = *helpers_[static_cast<std::size_t>(i) - 1];
      if (helper.at.load() != here || watch(microseconds(20), [&] { return helper.at.load() != here; }))
        continue;
      while (helper.at.load() == here) helper.at.wait(here);
    }
    taken_.fetch_and(~bit);
    loop.finish();
  }

  /// The child of a fork has the thread that forked, and no other.
  void forget() {
    for (auto& helper : helpers_) static_cast<void>(helper.release());  // their threads cannot be joined
    helpers_.clear();
    started_ = 0;
    open_ = 0;
    taken_ = 0;
  }
  std::mutex& mutex() { return mutex_; }

  void stop() {
    const std::lock_guard lock(mutex_);
    isStopped_ = true;
    for (const auto& helper : helpers_) wake(*helper);
    for (const auto& helper : helpers_) {
      if (helper->thread.get_id() == std::this_thread::get_id()) {
        helper->thread.detach();  // it ends the process
      } else {
        helper->thread.join();
      }
    }
    started_ = 0;  // they stay in memory for loops that have not ended
  }

 private:
  /// Starts as many helpers as are missing, if that can be done.
  void start(int helpers) {
    if (started_.load(std::memory_order_relaxed) >= helpers) return;
    if (Clock::now().time_since_epoch().count() < nextTry_.load(std::memory_order_relaxed)) return;
    const std::lock_guard lock(mutex_);
    if (isStopped_) return;
    // Signals are for the threads of the application.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    try {
      helpers_.reserve(mostHelpers);  // helpers read it while others start
      while (started_ < std::min(helpers, mostHelpers)) {
        Helper& helper = *helpers_.emplace_back(std::make_unique<Helper>());
        try {
          helper.thread = std::thread([this, &helper, number = started_ + 1] { help(helper, number); });
        } catch (...) {
          helpers_.pop_back();
          throw;
        }
        ++started_;
      }
    } catch (
        const std::exception&) {  // no more threads, or no memory: those that there are suffice for some time
      nextTry_ = (Clock::now() + std::chrono::seconds(1)).time_since_epoch().count();
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }

  int takePlace() {
    std::uint64_t taken = taken_.load();
    while (~taken != 0) {
      const int number = std::countr_one(taken);
      if (taken_.compare_exchange_weak(taken, taken | std::uint64_t{1} << number)) return number;
    }
    return -1;
  }

  static void wake(Helper& helper) {
    if (helper.sleeps.load() != 0 && helper.sleeps.exchange(0) != 0) helper.sleeps.notify_one();
  }
  /// Wakes the two helpers below a thread in a tree of all, so that nobody wakes many.
  void wakeBelow(int number, const Place& place) {
    const int threads = place.threads.load();
    for (const int below : {2 * number + 1, 2 * number + 2})
      if (below < threads) wake(*helpers_[static_cast<std::size_t>(below) - 1]);
  }

  /// The places of loops that this helper may help.
  std::uint64_t openTo(int number) const {
    std::uint64_t found = 0;
    for (std::uint64_t open = open_.load(); open != 0; open &= open - 1) {
      const int place = std::countr_zero(open);
      if (number < places_[place].threads.load()) found |= std::uint64_t{1} << place;
    }
    return found;
  }

  /// Whether fewer threads work than may. While there is one loop, its own limit is enough.
  bool hasProcessor() const {
    const int loops = std::popcount(taken_.load());
    if (loops <= 1) return true;
    int working = loops;
    for (int i = 0; i < started_.load(); ++i)
      working += helpers_[static_cast<std::size_t>(i)]->at.load(std::memory_order_relaxed) != 0;
    return working < mostThreads();
  }

  /// Works on a loop, if there is one and not all processors have work.
  bool helpWithLoop(Helper& self, int number) {
    for (std::uint64_t open = openTo(number); open != 0; open &= open - 1) {
      if (!hasProcessor()) return false;
      const std::uint64_t bit = open & -open;
      Place& place = places_[std::countr_zero(open)];
      self.at.store(static_cast<std::uint32_t>(std::countr_zero(open)) + 1);
      const bool hasTurn = (open_.load() & bit) != 0 && number < place.threads.load();
      if (hasTurn) {
        wakeBelow(number, place);
        place.loop->workAs(number);
        if ((open_.load() & bit) != 0) open_.fetch_and(~bit);  // all pieces have been taken
      }
      self.at.store(0);
      self.at.notify_one();
      if (hasTurn) return true;
    }
    return false;
  }

  /// What a helper's thread does. It watches for the next loop for as long as that has been worth it lately.
  void help(Helper& self, int number) {
    inLoop = true;
    constexpr microseconds shortest{2}, longest{100};
    std::chrono::nanoseconds patience = longest / 2;
    while (!isStopped_) {
      if (helpWithLoop(self, number)) continue;
      const auto isThere = [&] { return isStopped_ || (openTo(number) != 0 && hasProcessor()); };
      if (limits().watches && watch(patience, isThere)) continue;
      const Clock::time_point before = Clock::now();
      self.sleeps = 1;
      if (isThere()) {
        self.sleeps = 0;
        continue;
      }
      while (self.sleeps != 0) self.sleeps.wait(1);
      const bool cameSoon = Clock::now() - before < 2 * longest;
      patience = cameSoon ? std::min<std::chrono::nanoseconds>(2 * patience, longest)
                          : std::max<std::chrono::nanoseconds>(patience / 2, shortest);
    }
  }

  static constexpr int mostHelpers = 4095;
  std::array<Place, 64> places_;
  // What helpers watch, and what changes while they work, are on different lines of a cache.
  alignas(64) std::atomic<std::uint64_t> open_ = 0;  ///< places of loops with pieces that may be left
  std::atomic<bool> isStopped_ = false;
  alignas(64) std::atomic<std::uint64_t> taken_ = 0;  ///< places of loops
  std::atomic<int> started_ = 0;
  std::atomic<Clock::rep> nextTry_ = 0;  ///< to start helpers, after one that failed
  std::mutex mutex_;  ///< protects helpers_ where it grows
  std::vector<std::unique_ptr<Helper>> helpers_;
};

/// Is never destroyed: threads of the application may be in loops when the process ends.
Helpers& helpers() {
  static Helpers* const all = [] {
    auto* const made = new Helpers;
    pthread_atfork([] { helpers().mutex().lock(); }, [] { helpers().mutex().unlock(); },
                   [] {
                     helpers().forget();
                     helpers().mutex().unlock();
                   });
    return made;
  }();
  return *all;
}

/// Ends the helpers before their code goes.
struct Ending {
  ~Ending() { helpers().stop(); }
};

}  // namespace

SharedLoop::SharedLoop(std::int64_t count, std::int64_t pieces, int shares, void (*work)(void*, Range, int),
                       void* context)
    : count_(count), pieces_(pieces), shares_(shares), work_(work), context_(context) {
  for (int i = 0; i < shares_; ++i) {
    share_[static_cast<std::size_t>(i)].next.store(pieces * i / shares, std::memory_order_relaxed);
    share_[static_cast<std::size_t>(i)].end = pieces * (i + 1) / shares;
  }
}

void SharedLoop::workAs(int worker) {
  for (int i = 0; i < shares_; ++i) {
    Share& share = share_[static_cast<std::size_t>((worker + i) % shares_)];
    while (!hasThrown_.load(std::memory_order_relaxed) &&
           share.next.load(std::memory_order_relaxed) < share.end) {
      const std::int64_t piece = share.next.fetch_add(1, std::memory_order_relaxed);
      if (piece >= share.end) break;
      workOn(piece, worker);
    }
  }
}

void SharedLoop::workOn(std::int64_t piece, int worker) {
  try {
    work_(context_, {count_ * piece / pieces_, count_ * (piece + 1) / pieces_}, worker);
  } catch (...) {
    const std::lock_guard lock(mutex_);
    if (!thrown_) thrown_ = std::current_exception();
    hasThrown_ = true;
  }
}

int mostThreads() {
  const Limits& all = limits();
  const int wanted = omp_get_max_threads != nullptr ? omp_get_max_threads() : all.wanted;
  if (all.wanted > 0) return std::max(1, wanted);
  return wanted > 0 ? std::min(wanted, all.processors) : all.processors;
}

bool isInLoop() { return inLoop || (omp_in_parallel != nullptr && omp_in_parallel() != 0); }

void runShared(SharedLoop& loop, int threads, bool mayWake) {
  static const Ending ending;
  struct Within {
    Within() { inLoop = true; }
    ~Within() { inLoop = false; }
  } within;
  helpers().run(loop, threads, mayWake);
}

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

void inParallel(std::int64_t count, std::int64_t cost, Deal deal, void (*work)(void*, Range, int),
                void* context) {
  const std::int64_t threads = threadsFor(count, cost);
  if (threads <= 1) {
    work(context, {0, count}, 0);
    return;
  }
  const std::optional<std::int64_t> total = checkedProduct(count, cost);
  const std::int64_t pieces = piecesOf(count, total, threads, deal);
  const std::int64_t shares = std::min<std::int64_t>({threads, pieces, SharedLoop::mostShares});
  SharedLoop loop(count, pieces, static_cast<int>(shares), work, context);
  runShared(loop, static_cast<int>(threads), !total || *total >= worthWaking);
}

}  // namespace sk::native
