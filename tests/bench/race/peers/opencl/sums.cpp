// SPDX-License-Identifier: MIT
//
// Sums: each work item folds a run of elements in the lanes of vectors, as processors like it; few partial sums are left,
// which the host adds.
#include <algorithm>

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

kernel void sum(int run, global const float16* restrict x, global float* restrict parts) {
  size_t item = get_global_id(0);
  global const float16* mine = x + item * run;
  float16 a = 0, b = 0, c = 0, d = 0;
  for (int i = 0; i < run; i += 4) {
    a += mine[i];
    b += mine[i + 1];
    c += mine[i + 2];
    d += mine[i + 3];
  }
  parts[2 * item] = folded((a + b) + (c + d));
  parts[2 * item + 1] = 0;
}

kernel void dotted(int run, global const float16* restrict x, global const float16* restrict y,
                   global float* restrict parts) {
  size_t item = get_global_id(0);
  global const float16* mine = x + item * run;
  global const float16* other = y + item * run;
  float16 a = 0, b = 0, c = 0, d = 0;
  for (int i = 0; i < run; i += 4) {
    a += mine[i] * other[i];
    b += mine[i + 1] * other[i + 1];
    c += mine[i + 2] * other[i + 2];
    d += mine[i + 3] * other[i + 3];
  }
  parts[2 * item] = folded((a + b) + (c + d));
  parts[2 * item + 1] = 0;
}

// TwoSum; the second of each pair of parts is what the first has lost.
#define ADD(sum, error, x) do { \
    float16 s = sum + x; \
    float16 part = s - sum; \
    error += (sum - (s - part)) + (x - part); \
    sum = s; \
  } while (0)

kernel void compensated(int run, global const float16* restrict x, global float* restrict parts) {
  size_t item = get_global_id(0);
  global const float16* mine = x + item * run;
  float16 a = 0, b = 0, c = 0, d = 0, ea = 0, eb = 0, ec = 0, ed = 0;
  for (int i = 0; i < run; i += 4) {
    ADD(a, ea, mine[i]);
    ADD(b, eb, mine[i + 1]);
    ADD(c, ec, mine[i + 2]);
    ADD(d, ed, mine[i + 3]);
  }
  ADD(a, ea, b);
  ADD(a, ea, c);
  ADD(a, ea, d);
  ea += eb + ec + ed;
  float sums[16], total = 0, lost = folded(ea);
  vstore16(a, 0, sums);
  for (int i = 0; i < 16; ++i) {
    float s = total + sums[i], part = s - total;
    lost += (total - (s - part)) + (sums[i] - part);
    total = s;
  }
  parts[2 * item] = total;
  parts[2 * item + 1] = lost;
}
)";

class Sum final : public ClTask {
 public:
  Sum(const Problem& p, const char* kernel)
      : items_(std::min<std::size_t>(static_cast<std::size_t>(p.size()) / 64,
                                     16 * ClDevice::instance().units())),
        parts_(2 * items_ * sizeof(float)),
        kernel_(text, kernel) {
    // Sizes are powers of two; so must the number of items be.
    while ((items_ & (items_ - 1)) != 0) items_ &= items_ - 1;
    for (const auto& values : p.floats) inputs_.push_back(std::make_unique<ClBuffer>(values));
    const auto run = static_cast<std::int32_t>(static_cast<std::size_t>(p.size()) / 16 / items_);
    if (inputs_.size() == 1) {
      kernel_.with(run, *inputs_[0], parts_);
    } else {
      kernel_.with(run, *inputs_[0], *inputs_[1], parts_);
    }
    kernel_.over({items_}, {1});
  }
  std::vector<float> result() override { return {static_cast<float>(total_)}; }

 private:
  void once() override {
    kernel_.enqueue();
    total_ = 0;
    for (const float part : parts_.readFloats(2 * items_)) total_ += part;
  }

  std::size_t items_;
  std::vector<std::unique_ptr<ClBuffer>> inputs_;
  ClBuffer parts_;
  ClKernel kernel_;
  double total_ = 0;
};

}  // namespace

std::unique_ptr<Task> sumOpenCl(const Problem& p) { return std::make_unique<Sum>(p, "sum"); }
std::unique_ptr<Task> dotOpenCl(const Problem& p) { return std::make_unique<Sum>(p, "dotted"); }
std::unique_ptr<Task> compensatedSumOpenCl(const Problem& p) {
  return std::make_unique<Sum>(p, "compensated");
}

}  // namespace race
