// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
kernel void saxpy(float a, global const float* restrict x, global const float* restrict y, global float* restrict r) {
  size_t i = get_global_id(0);
  r[i] = a * x[i] + y[i];
}
)";

}  // namespace

std::unique_ptr<Task> saxpyOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const ClBuffer& x = task->buffer(p.floats[0]);
  const ClBuffer& y = task->buffer(p.floats[1]);
  const ClBuffer& r = task->buffer(bytesOf(p));
  task->step(text, "saxpy").with(saxpyFactor, x, y, r).over({sizeOf(p)});
  task->gives(r, sizeOf(p));
  return task;
}

}  // namespace race
