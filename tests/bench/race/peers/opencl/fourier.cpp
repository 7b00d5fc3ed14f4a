// SPDX-License-Identifier: MIT
//
// Radix 2 in Stockham's order.
#include <cmath>

#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
kernel void join(int stride, global const float2* restrict roots, global const float2* restrict from,
                 global float2* restrict to) {
  size_t k = get_global_id(0), pairs = get_global_size(0);
  size_t q = k & (stride - 1);
  float2 a = from[k], b = from[k + pairs], root = roots[k - q], d = a - b;
  to[2 * k - q] = a + b;
  to[2 * k - q + stride] = (float2)(d.x * root.x - d.y * root.y, d.x * root.y + d.y * root.x);
}
)";

}  // namespace

std::unique_ptr<Task> fourierOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  std::vector<float> roots;
  for (std::int64_t k = 0; k < p.size() / 2; ++k) {
    const double angle = -2 * std::acos(-1.0) * static_cast<double>(k) / static_cast<double>(p.size());
    roots.push_back(static_cast<float>(std::cos(angle)));
    roots.push_back(static_cast<float>(std::sin(angle)));
  }
  const ClBuffer& rootBuffer = task->buffer(roots);
  const ClBuffer* from = &task->buffer(p.floats[0]);
  const ClBuffer* to = &task->buffer(2 * bytesOf(p));
  const ClBuffer* other = &task->buffer(2 * bytesOf(p));
  for (std::int32_t stride = 1; stride < p.size(); stride *= 2) {
    task->step(text, "join").with(stride, rootBuffer, *from, *to).over({sizeOf(p) / 2});
    from = to;
    std::swap(to, other);
  }
  task->gives(*from, 2 * sizeOf(p));
  return task;
}

}  // namespace race
