// SPDX-License-Identifier: MIT
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
kernel void sparse(global const int* restrict starts, global const int* restrict columns,
                   global const float* restrict values, global const float* restrict x, global float* restrict y) {
  size_t row = get_global_id(0);
  int end = starts[row + 1];
  float sum = 0;
  for (int i = starts[row]; i < end; ++i) sum += values[i] * x[columns[i]];
  y[row] = sum;
}
)";

}  // namespace

std::unique_ptr<Task> sparseOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const ClBuffer& starts = task->buffer(p.ints[0]);
  const ClBuffer& columns = task->buffer(p.ints[1]);
  const ClBuffer& values = task->buffer(p.floats[0]);
  const ClBuffer& x = task->buffer(p.floats[1]);
  const ClBuffer& y = task->buffer(bytesOf(p));
  task->step(text, "sparse").with(starts, columns, values, x, y).over({sizeOf(p)});
  task->gives(y, sizeOf(p));
  return task;
}

}  // namespace race
