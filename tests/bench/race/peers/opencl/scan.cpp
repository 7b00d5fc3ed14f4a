// SPDX-License-Identifier: MIT
//
// Prefix sums: work items sum runs, one sums these sums, and the runs are gone through once more.
#include <algorithm>

#include "peers/opencl/all.hpp"
#include "peers/opencl/device.hpp"

namespace race {
namespace {

const char* const text = R"(
kernel void sumRuns(int run, global const int* restrict x, global int* restrict sums) {
  size_t item = get_global_id(0);
  int sum = 0;
  for (int i = 0; i < run; ++i) sum += x[item * run + i];
  sums[item] = sum;
}

kernel void scanSums(int count, global int* restrict sums) {
  int before = 0;
  for (int i = 0; i < count; ++i) {
    int sum = sums[i];
    sums[i] = before;
    before += sum;
  }
}

kernel void scanRuns(int run, global const int* restrict x, global const int* restrict sums, global int* restrict r) {
  size_t item = get_global_id(0);
  int before = sums[item];
  for (int i = 0; i < run; ++i) {
    r[item * run + i] = before;
    before += x[item * run + i];
  }
}

kernel void toFloats(global const int* restrict x, global float* restrict r) {
  r[get_global_id(0)] = x[get_global_id(0)];
}
)";

class Scan final : public ClTask {
 public:
  explicit Scan(const Problem& p)
      : size_(sizeOf(p)),
        items_(std::min<std::size_t>(size_ / 16, 64)),
        x_(p.ints[0]),
        sums_(items_ * sizeof(std::int32_t)),
        before_(size_ * sizeof(std::int32_t)),
        sumRuns_(text, "sumRuns"),
        scanSums_(text, "scanSums"),
        scanRuns_(text, "scanRuns") {
    const auto run = static_cast<std::int32_t>(size_ / items_);
    sumRuns_.with(run, x_, sums_).over({items_}, {1});
    scanSums_.with(static_cast<std::int32_t>(items_), sums_).over({1}, {1});
    scanRuns_.with(run, x_, sums_, before_).over({items_}, {1});
  }

  std::vector<float> result() override {
    const ClBuffer floats(size_ * sizeof(float));
    ClKernel toFloats(text, "toFloats");
    toFloats.with(before_, floats).over({size_}).enqueue();
    return floats.readFloats(size_);
  }

 private:
  void once() override {
    sumRuns_.enqueue();
    scanSums_.enqueue();
    scanRuns_.enqueue();
  }

  std::size_t size_, items_;
  ClBuffer x_, sums_, before_;
  ClKernel sumRuns_, scanSums_, scanRuns_;
};

}  // namespace

std::unique_ptr<Task> scanOpenCl(const Problem& p) { return std::make_unique<Scan>(p); }

}  // namespace race
