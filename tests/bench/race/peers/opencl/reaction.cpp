// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
// feed, kill and the two spreads.
kernel void advance(float4 medium, global const float2* restrict c, global float2* restrict next) {
  int x = get_global_id(0), y = get_global_id(1), columns = get_global_size(0), rows = get_global_size(1);
  global const float2* row = c + (size_t)y * columns;
  global const float2* above = c + (size_t)(y == 0 ? rows - 1 : y - 1) * columns;
  global const float2* below = c + (size_t)(y + 1 == rows ? 0 : y + 1) * columns;
  float2 here = row[x];
  float2 lap = row[x == 0 ? columns - 1 : x - 1] + row[x + 1 == columns ? 0 : x + 1] + above[x] + below[x] - 4 * here;
  float reaction = here.x * here.y * here.y;
  next[(size_t)y * columns + x] =
      here + (float2)(medium.z * lap.x - reaction + medium.x * (1 - here.x),
                      medium.w * lap.y + reaction - (medium.x + medium.y) * here.y);
}
)";

}  // namespace

std::unique_ptr<Task> reactionOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const cl_float4 medium = {{reactionFeed, reactionKill, reactionSpreadU, reactionSpreadV}};
  const ClBuffer* from = &task->buffer(p.floats[0]);
  const ClBuffer* to = &task->buffer(2 * bytesOf(p));
  const ClBuffer* other = &task->buffer(2 * bytesOf(p));
  for (int step = 0; step < reactionSteps; ++step) {
    task->step(text, "advance")
        .with(medium, *from, *to)
        .over({static_cast<std::size_t>(p.columns), static_cast<std::size_t>(p.rows)});
    from = to;
    std::swap(to, other);
  }
  task->gives(*from, 2 * sizeOf(p));
  return task;
}

}  // namespace race
