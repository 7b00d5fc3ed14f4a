// SPDX-License-Identifier: MIT
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

kernel void gemv(int columns, global const float* restrict a, global const float* restrict x, global float* restrict y) {
  size_t row = get_global_id(0);
  global const float* mine = a + row * columns;
  float16 sum = 0;
  for (int i = 0; i < columns; i += 16) sum += vload16(0, mine + i) * vload16(0, x + i);
  y[row] = folded(sum);
}

// A work item has a tile of C: four rows of sixteen columns.
kernel void gemm(int columns, global const float* restrict a, global const float* restrict b, global float* restrict c) {
  size_t x = 16 * get_global_id(0);
  global const float* rows = a + 4 * get_global_id(1) * columns;
  float16 t0 = 0, t1 = 0, t2 = 0, t3 = 0;
  for (int k = 0; k < columns; ++k) {
    float16 row = vload16(0, b + (size_t)k * columns + x);
    t0 += rows[k] * row;
    t1 += rows[columns + k] * row;
    t2 += rows[2 * columns + k] * row;
    t3 += rows[3 * columns + k] * row;
  }
  global float* tile = c + 4 * get_global_id(1) * columns + x;
  vstore16(t0, 0, tile);
  vstore16(t1, 0, tile + columns);
  vstore16(t2, 0, tile + 2 * columns);
  vstore16(t3, 0, tile + 3 * columns);
}
)";

}  // namespace

std::unique_ptr<Task> gemvOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const auto rows = static_cast<std::size_t>(p.rows);
  const ClBuffer& a = task->buffer(p.floats[0]);
  const ClBuffer& x = task->buffer(p.floats[1]);
  const ClBuffer& y = task->buffer(rows * sizeof(float));
  task->step(text, "gemv").with(static_cast<std::int32_t>(p.columns), a, x, y).over({rows});
  task->gives(y, rows);
  return task;
}

std::unique_ptr<Task> gemmOpenCl(const Problem& p) {
  auto task = std::make_unique<ClSteps>();
  const ClBuffer& a = task->buffer(p.floats[0]);
  const ClBuffer& b = task->buffer(p.floats[1]);
  const ClBuffer& c = task->buffer(bytesOf(p));
  task->step(text, "gemm")
      .with(static_cast<std::int32_t>(p.columns), a, b, c)
      .over({static_cast<std::size_t>(p.columns) / 16, static_cast<std::size_t>(p.rows) / 4});
  task->gives(c, sizeOf(p));
  return task;
}

}  // namespace race
