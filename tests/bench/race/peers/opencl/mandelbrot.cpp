// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
// 16 pixels of a row are the lanes of vectors, which go together until all have escaped.
kernel void escape(float left, float top, float perColumn, float perRow, int most, global float16* restrict result) {
  const float16 lanes = (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  float16 cx = left + perColumn * ((float)(16 * get_global_id(0)) + lanes + 0.5f);
  float16 cy = top + perRow * ((float)get_global_id(1) + 0.5f);
  float16 x = 0, y = 0;
  int16 steps = 0;
  for (int round = 0; round < most; ++round) {
    int16 inside = x * x + y * y <= 4.0f;  // -1 where it holds
    steps -= inside;
    if (!any(inside)) break;
    float16 next = x * x - y * y + cx;
    y = 2 * x * y + cy;
    x = next;
  }
  result[get_global_id(1) * get_global_size(0) + get_global_id(0)] = convert_float16(steps);
}
)";

}  // namespace

std::unique_ptr<Task> mandelbrotOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const ClBuffer& steps = task->buffer(bytesOf(p));
  task->step(text, "escape")
      .with(mandelbrotLeft, mandelbrotTop, mandelbrotExtent / static_cast<float>(p.columns),
            mandelbrotExtent / static_cast<float>(p.rows), mandelbrotSteps, steps)
      .over({static_cast<std::size_t>(p.columns) / 16, static_cast<std::size_t>(p.rows)});
  task->gives(steps, sizeOf(p));
  return task;
}

}  // namespace race
