// SPDX-License-Identifier: MIT
#include "constants.hpp"
#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
float folded(float16 v) {
  float8 a = v.lo + v.hi;
  float4 b = a.lo + a.hi;
  return b.x + b.y + b.z + b.w;
}

kernel void attract(int n, float softening, global const float* restrict x, global const float* restrict y,
                    global const float* restrict z, global const float* restrict mass, global float* restrict r) {
  size_t i = get_global_id(0);
  float16 ax = 0, ay = 0, az = 0;
  for (int j = 0; j < n; j += 16) {
    float16 dx = vload16(0, x + j) - x[i], dy = vload16(0, y + j) - y[i], dz = vload16(0, z + j) - z[i];
    float16 nearness = 1 / sqrt(dx * dx + dy * dy + dz * dz + softening);
    float16 pull = vload16(0, mass + j) * nearness * nearness * nearness;
    ax += pull * dx;
    ay += pull * dy;
    az += pull * dz;
  }
  r[3 * i] = folded(ax);
  r[3 * i + 1] = folded(ay);
  r[3 * i + 2] = folded(az);
}
)";

}  // namespace

std::unique_ptr<Task> bodiesOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const ClBuffer& x = task->buffer(p.floats[0]);
  const ClBuffer& y = task->buffer(p.floats[1]);
  const ClBuffer& z = task->buffer(p.floats[2]);
  const ClBuffer& mass = task->buffer(p.floats[3]);
  const ClBuffer& r = task->buffer(3 * bytesOf(p));
  task->step(text, "attract")
      .with(static_cast<std::int32_t>(p.size()), softening, x, y, z, mass, r)
      .over({sizeOf(p)});
  task->gives(r, 3 * sizeOf(p));
  return task;
}

}  // namespace race
