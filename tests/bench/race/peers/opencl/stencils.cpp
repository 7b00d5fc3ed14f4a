// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
kernel void heat(float flow, int rows, int columns, global const float* restrict u, global float* restrict v) {
  int x = get_global_id(0), y = get_global_id(1);
  global const float* row = u + (size_t)y * columns;
  global const float* above = u + (size_t)max(y - 1, 0) * columns;
  global const float* below = u + (size_t)min(y + 1, rows - 1) * columns;
  float sum = row[max(x - 1, 0)] + row[min(x + 1, columns - 1)] + above[x] + below[x];
  v[(size_t)y * columns + x] = row[x] + flow * (sum - 4 * row[x]);
}

kernel void binomial(float flow, int rows, int columns, global const float* restrict u, global float* restrict v) {
  int x = get_global_id(0), y = get_global_id(1);
  int left = max(x - 1, 0), right = min(x + 1, columns - 1);
  global const float* row = u + (size_t)y * columns;
  global const float* above = u + (size_t)max(y - 1, 0) * columns;
  global const float* below = u + (size_t)min(y + 1, rows - 1) * columns;
  float corners = above[left] + above[right] + below[left] + below[right];
  float sides = above[x] + row[left] + row[right] + below[x];
  v[(size_t)y * columns + x] = (corners + 2 * sides + 4 * row[x]) / 16;
}
)";

std::unique_ptr<Task> stencil(const Problem& p, const char* kernel) {
  auto task = std::make_unique<ClSteps>();
  const ClBuffer& u = task->buffer(p.floats[0]);
  const ClBuffer& v = task->buffer(bytesOf(p));
  task->step(text, kernel)
      .with(heatFlow, static_cast<std::int32_t>(p.rows), static_cast<std::int32_t>(p.columns), u, v)
      .over({static_cast<std::size_t>(p.columns), static_cast<std::size_t>(p.rows)});
  task->gives(v, sizeOf(p));
  return task;
}

}  // namespace

std::unique_ptr<Task> heatOpenCl(const Problem& p) { return stencil(p, "heat"); }
std::unique_ptr<Task> binomialOpenCl(const Problem& p) { return stencil(p, "binomial"); }

}  // namespace race
