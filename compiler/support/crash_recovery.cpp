// SPDX-License-Identifier: MIT
#include "support/crash_recovery.hpp"

#include <array>
#include <csetjmp>
#include <csignal>
#include <cstddef>
#include <vector>

namespace skc {
namespace {

constexpr std::array signals = {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
constexpr std::size_t stackSize = 1 << 16;

thread_local sigjmp_buf* returnPoint = nullptr;

void onCrash(int signal) {
  if (returnPoint != nullptr) siglongjmp(*returnPoint, 1);
  std::signal(signal, SIG_DFL);  // of another thread
  raise(signal);
}

/// Handles the signals of crashes, on a stack of its own, during its lifetime.
class Handlers {
 public:
  Handlers() {
    stack_t own{};
    own.ss_sp = stack_.data();
    own.ss_size = stack_.size();
    sigaltstack(&own, &outerStack_);
    struct sigaction action{};
    action.sa_handler = onCrash;
    action.sa_flags = SA_ONSTACK;
    for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &action, &outer_[i]);
  }
  ~Handlers() {
    returnPoint = nullptr;
    for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &outer_[i], nullptr);
    sigaltstack(&outerStack_, nullptr);
  }
  Handlers(const Handlers&) = delete;
  Handlers& operator=(const Handlers&) = delete;

 private:
  std::vector<char> stack_ = std::vector<char>(stackSize);
  stack_t outerStack_{};
  std::array<struct sigaction, signals.size()> outer_{};
};

}  // namespace

bool survivesCrash(FunctionRef<void()> work) {
  const Handlers handlers;
  sigjmp_buf point;
  returnPoint = &point;
  if (sigsetjmp(point, 1) != 0) return false;
  work();
  return true;
}

}  // namespace skc
