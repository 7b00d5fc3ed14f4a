// SPDX-License-Identifier: MIT
//
// A bitonic network, whose pairs are exchanged where they are.
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
kernel void copy(global const float* restrict from, global float* restrict to) {
  to[get_global_id(0)] = from[get_global_id(0)];
}

// Item i has the pair whose lower element is the i-th of those whose bit `top`, the highest in which partners differ, is 0.
kernel void exchange(int top, int fold, global float* keys) {
  int i = get_global_id(0);
  int here = (i & (top - 1)) | ((i & ~(top - 1)) << 1);
  int there = here ^ fold;
  float a = keys[here], b = keys[there];
  keys[here] = fmin(a, b);
  keys[there] = fmax(a, b);
}
)";

}  // namespace

std::unique_ptr<Task> sortOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const ClBuffer& keys = task->buffer(p.floats[0]);
  const ClBuffer& sorted = task->buffer(bytesOf(p));
  task->step(text, "copy").with(keys, sorted).over({sizeOf(p)});
  const auto exchange = [&](int top, int fold) {
    task->step(text, "exchange").with(top, fold, sorted).over({sizeOf(p) / 2});
  };
  for (int run = 1; run < static_cast<int>(p.size()); run *= 2) {
    exchange(run, 2 * run - 1);
    for (int distance = run / 2; distance > 0; distance /= 2) exchange(distance, distance);
  }
  task->gives(sorted, sizeOf(p));
  return task;
}

}  // namespace race
