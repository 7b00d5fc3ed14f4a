// SPDX-License-Identifier: MIT
#include "driver/big_stack.hpp"

#include <cstddef>

#include <pthread.h>

namespace skc::driver {
namespace {

constexpr std::size_t stackBytes = std::size_t{512} << 20;   // address space; only used pages cost memory

struct StackJob {
  const std::function<int()>* work;
  int status = 1;
};

void* runJob(void* pointer) {
  auto* job = static_cast<StackJob*>(pointer);
  job->status = (*job->work)();
  return nullptr;
}

}  // namespace

int withBigStack(const std::function<int()>& work) {
  StackJob job{&work};
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_t thread{};
  const bool started = pthread_attr_setstacksize(&attributes, stackBytes) == 0 &&
                       pthread_create(&thread, &attributes, runJob, &job) == 0;
  pthread_attr_destroy(&attributes);
  if (!started) return work();   // not enough address space: use the ordinary stack
  pthread_join(thread, nullptr);
  return job.status;
}

}  // namespace skc::driver
