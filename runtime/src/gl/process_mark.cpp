// SPDX-License-Identifier: MIT
#include "gl/process_mark.hpp"

#include <pthread.h>

namespace sk::gl {

std::atomic<unsigned> ProcessMark::forks = 0;

unsigned ProcessMark::watchedForks() {
  [[maybe_unused]] static const int watching = pthread_atfork(nullptr, nullptr, [] { ++forks; });
  return forks.load(std::memory_order_relaxed);
}

}  // namespace sk::gl
