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

class Saxpy final : public ClTask {
 public:
  explicit Saxpy(const Problem& p)
      : size_(static_cast<std::size_t>(p.size())),
        x_(p.floats[0]),
        y_(p.floats[1]),
        r_(size_ * sizeof(float)),
        kernel_(text, "saxpy") {
    kernel_.with(saxpyFactor, x_, y_, r_).over({size_});
  }
  std::vector<float> result() override { return r_.readFloats(size_); }

 private:
  void once() override { kernel_.enqueue(); }

  std::size_t size_;
  ClBuffer x_, y_, r_;
  ClKernel kernel_;
};

}  // namespace

std::unique_ptr<Task> saxpyOpenCl(const Problem& p) { return std::make_unique<Saxpy>(p); }

}  // namespace race
