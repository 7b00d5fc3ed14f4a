// SPDX-License-Identifier: MIT
//
// CUDA: CUB where it has the program, plain kernels as one writes them where it has not. No part of the build: on a machine
// with nvcc, tests/bench/gpu.sh compiles it beside sk_race.
#include <cub/cub.cuh>
#include <cuda_runtime.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "constants.hpp"
#include "contender.hpp"

namespace race {
namespace {

void check(cudaError_t status) {
  if (status != cudaSuccess) throw std::runtime_error(std::string("CUDA: ") + cudaGetErrorString(status));
}

template <class T>
class Array {
 public:
  explicit Array(std::size_t size) : size_(size) { check(cudaMalloc(&data_, size * sizeof(T))); }
  explicit Array(const std::vector<T>& values) : Array(values.size()) {
    check(cudaMemcpy(data_, values.data(), size_ * sizeof(T), cudaMemcpyHostToDevice));
  }
  ~Array() { cudaFree(data_); }
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;

  T* data() const { return data_; }
  std::vector<T> read() const {
    std::vector<T> values(size_);
    check(cudaMemcpy(values.data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost));
    return values;
  }

 private:
  T* data_ = nullptr;
  std::size_t size_;
};

struct IsPositive {
  __host__ __device__ bool operator()(float x) const { return x > 0; }
};
constexpr IsPositive isPositive;

constexpr int block = 256;
int blocksOf(std::int64_t n) { return static_cast<int>((n + block - 1) / block); }
std::size_t sizeOf(const Problem& p) { return static_cast<std::size_t>(p.size()); }

/// A task of a problem with arrays of floats in and one out.
class FloatTask final : public Task {
 public:
  using Function = std::function<void(const FloatTask&)>;

  FloatTask(const Problem& p, std::size_t resultSize, Function function)
      : rows(p.rows), columns(p.columns), r(resultSize), function_(std::move(function)) {
    for (const auto& values : p.floats) x.push_back(std::make_unique<Array<float>>(values));
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) function_(*this);
    check(cudaGetLastError());
    check(cudaDeviceSynchronize());
  }
  std::vector<float> result() override { return r.read(); }

  std::int64_t rows, columns;
  std::vector<std::unique_ptr<Array<float>>> x;
  Array<float> r;

 private:
  Function function_;
};

__global__ void saxpy(float a, const float* x, const float* y, float* r, std::int64_t n) {
  const std::int64_t i = std::int64_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i < n) r[i] = a * x[i] + y[i];
}

__device__ float at(const float* u, int y, int x, int rows, int columns) {
  y = min(max(y, 0), rows - 1);
  x = min(max(x, 0), columns - 1);
  return u[std::int64_t{y} * columns + x];
}

__global__ void heat(float flow, const float* u, float* v, int rows, int columns) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  if (x >= columns || y >= rows) return;
  const float here = u[std::int64_t{y} * columns + x];
  v[std::int64_t{y} * columns + x] =
      here + flow * (at(u, y, x - 1, rows, columns) + at(u, y, x + 1, rows, columns) +
                     at(u, y - 1, x, rows, columns) + at(u, y + 1, x, rows, columns) - 4 * here);
}

__global__ void binomial(float, const float* u, float* v, int rows, int columns) {
  const int x = blockIdx.x * blockDim.x + threadIdx.x, y = blockIdx.y * blockDim.y + threadIdx.y;
  if (x >= columns || y >= rows) return;
  const auto near = [&](int dy, int dx) { return at(u, y + dy, x + dx, rows, columns); };
  const float corners = near(-1, -1) + near(-1, 1) + near(1, -1) + near(1, 1);
  const float sides = near(-1, 0) + near(0, -1) + near(0, 1) + near(1, 0);
  v[std::int64_t{y} * columns + x] = (corners + 2 * sides + 4 * near(0, 0)) / 16;
}

__global__ void escape(float* steps, int rows, int columns) {
  const int column = blockIdx.x * blockDim.x + threadIdx.x, row = blockIdx.y * blockDim.y + threadIdx.y;
  if (column >= columns || row >= rows) return;
  const float cx = mandelbrotLeft + mandelbrotExtent / columns * (column + 0.5f);
  const float cy = mandelbrotTop + mandelbrotExtent / rows * (row + 0.5f);
  float x = 0, y = 0;
  int count = 0;
  for (; count < mandelbrotSteps && x * x + y * y <= 4; ++count) {
    const float next = x * x - y * y + cx;
    y = 2 * x * y + cy;
    x = next;
  }
  steps[std::int64_t{row} * columns + column] = static_cast<float>(count);
}

/// Bodies in shared memory, a block's worth at a time.
__global__ void attract(const float* x, const float* y, const float* z, const float* mass, float* r, int n) {
  __shared__ float4 others[block];
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  const float px = x[min(i, n - 1)], py = y[min(i, n - 1)], pz = z[min(i, n - 1)];
  float ax = 0, ay = 0, az = 0;
  for (int first = 0; first < n; first += block) {
    const int j = first + threadIdx.x;
    others[threadIdx.x] = j < n ? make_float4(x[j], y[j], z[j], mass[j]) : make_float4(0, 0, 0, 0);
    __syncthreads();
    for (int k = 0; k < block; ++k) {
      const float dx = others[k].x - px, dy = others[k].y - py, dz = others[k].z - pz;
      const float nearness = rsqrtf(dx * dx + dy * dy + dz * dz + softening);
      const float pull = others[k].w * nearness * nearness * nearness;
      ax += pull * dx;
      ay += pull * dy;
      az += pull * dz;
    }
    __syncthreads();
  }
  if (i < n) {
    r[3 * i] = ax;
    r[3 * i + 1] = ay;
    r[3 * i + 2] = az;
  }
}

std::unique_ptr<Task> overGrid(const Problem& p, void (*kernel)(float, const float*, float*, int, int)) {
  return std::make_unique<FloatTask>(p, sizeOf(p), [kernel](const FloatTask& t) {
    const dim3 threads(32, 8), blocks(static_cast<unsigned>((t.columns + 31) / 32), static_cast<unsigned>((t.rows + 7) / 8));
    kernel<<<blocks, threads>>>(heatFlow, t.x[0]->data(), t.r.data(), static_cast<int>(t.rows),
                                static_cast<int>(t.columns));
  });
}

/// A CUB algorithm of a problem's integers or floats: call(memory, bytes) as CUB has it, asked for the bytes first.
template <class T>
class CubTask final : public Task {
 public:
  using Call = std::function<cudaError_t(void* memory, std::size_t& bytes, const T* from, T* to)>;

  CubTask(const std::vector<T>& values, std::size_t resultSize, bool toHost, Call call)
      : from_(values), to_(resultSize), toHost_(toHost), call_(std::move(call)) {
    check(call_(nullptr, bytes_, from_.data(), to_.data()));
    memory_ = std::make_unique<Array<char>>(bytes_);
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) {
      check(call_(memory_->data(), bytes_, from_.data(), to_.data()));
      if (toHost_) host_ = to_.read();
    }
    check(cudaDeviceSynchronize());
  }
  std::vector<float> result() override {
    const std::vector<T> values = to_.read();
    return {values.begin(), values.end()};
  }

 private:
  Array<T> from_, to_;
  bool toHost_;
  Call call_;
  std::size_t bytes_ = 0;
  std::unique_ptr<Array<char>> memory_;
  std::vector<T> host_;
};

}  // namespace
}  // namespace race

#include "peers/cuda/rays.cuh"

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  addRays(contenders);
  int devices = 0;
  check(cudaGetDeviceCount(&devices));
  contenders.push_back({"saxpy", "CUDA", [](const Problem& p) {
                          return std::make_unique<FloatTask>(p, sizeOf(p), [](const FloatTask& t) {
                            const std::int64_t n = t.rows * t.columns;
                            saxpy<<<blocksOf(n), block>>>(saxpyFactor, t.x[0]->data(), t.x[1]->data(), t.r.data(), n);
                          });
                        }});
  contenders.push_back({"5-point stencil", "CUDA", [](const Problem& p) { return overGrid(p, heat); }});
  contenders.push_back({"9-point stencil", "CUDA", [](const Problem& p) { return overGrid(p, binomial); }});
  contenders.push_back({"mandelbrot", "CUDA", [](const Problem& p) {
                          return std::make_unique<FloatTask>(p, sizeOf(p), [](const FloatTask& t) {
                            const dim3 threads(32, 8), blocks(static_cast<unsigned>((t.columns + 31) / 32),
                                                              static_cast<unsigned>((t.rows + 7) / 8));
                            escape<<<blocks, threads>>>(t.r.data(), static_cast<int>(t.rows), static_cast<int>(t.columns));
                          });
                        }});
  contenders.push_back({"n-body", "CUDA", [](const Problem& p) {
                          return std::make_unique<FloatTask>(p, 3 * sizeOf(p), [](const FloatTask& t) {
                            const auto n = static_cast<int>(t.rows * t.columns);
                            attract<<<blocksOf(n), block>>>(t.x[0]->data(), t.x[1]->data(), t.x[2]->data(),
                                                            t.x[3]->data(), t.r.data(), n);
                          });
                        }});
  contenders.push_back({"sum", "CUB", [](const Problem& p) {
                          const auto n = static_cast<int>(p.size());
                          return std::make_unique<CubTask<float>>(
                              p.floats[0], 1, true, [n](void* memory, std::size_t& bytes, const float* from, float* to) {
                                return cub::DeviceReduce::Sum(memory, bytes, from, to, n);
                              });
                        }});
  contenders.push_back({"prefix scan", "CUB", [](const Problem& p) {
                          const auto n = static_cast<int>(p.size());
                          return std::make_unique<CubTask<std::int32_t>>(
                              p.ints[0], sizeOf(p), false,
                              [n](void* memory, std::size_t& bytes, const std::int32_t* from, std::int32_t* to) {
                                return cub::DeviceScan::ExclusiveSum(memory, bytes, from, to, n);
                              });
                        }});
  contenders.push_back({"compaction", "CUB", [](const Problem& p) {
                          const auto n = static_cast<int>(p.size());
                          const auto kept = std::count_if(p.floats[0].begin(), p.floats[0].end(), isPositive);
                          auto count = std::make_shared<Array<int>>(std::size_t{1});
                          return std::make_unique<CubTask<float>>(
                              p.floats[0], static_cast<std::size_t>(kept), false,
                              [n, count](void* memory, std::size_t& bytes, const float* from, float* to) {
                                return cub::DeviceSelect::If(memory, bytes, from, to, count->data(), n, isPositive);
                              });
                        }});
  contenders.push_back({"sort", "CUB", [](const Problem& p) {
                          const auto n = static_cast<int>(p.size());
                          return std::make_unique<CubTask<float>>(
                              p.floats[0], sizeOf(p), false,
                              [n](void* memory, std::size_t& bytes, const float* from, float* to) {
                                return cub::DeviceRadixSort::SortKeys(memory, bytes, from, to, n);
                              });
                        }});
  contenders.push_back({"sort of pairs", "CUB", [](const Problem& p) {
                          const auto n = static_cast<int>(p.size());
                          std::vector<float> keysAndValues = p.floats[0];
                          for (const float key : p.floats[0]) keysAndValues.push_back(2 * key);
                          const auto keys = std::make_shared<Array<float>>(sizeOf(p));
                          return std::make_unique<CubTask<float>>(
                              keysAndValues, sizeOf(p), false,
                              [n, keys](void* memory, std::size_t& bytes, const float* from, float* to) {
                                return cub::DeviceRadixSort::SortPairs(memory, bytes, from, keys->data(), from + n, to, n);
                              });
                        }});
}
