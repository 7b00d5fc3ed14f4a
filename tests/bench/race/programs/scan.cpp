// SPDX-License-Identifier: MIT
//
// What comes before each element: the exclusive prefix sums of integers. ints: x.
#include <vector>

#include "our_task.hpp"
#include "programs/all.hpp"
#include "programs/sums.sk.hpp"

namespace race {
namespace {

class Scan final : public OurTask {
 public:
  Scan(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        prefix_(kernels::prefix.with(options).with({.scan = sk::Scan::Exclusive})),
        x_(filled<std::int32_t>({p.size()}, p.ints[0])),
        sums_(device.stream<std::int32_t>({p.size()})) {}

  std::vector<float> result() override {
    const std::vector<std::int32_t> sums = sums_.read();
    return {sums.begin(), sums.end()};
  }

 private:
  void once() override { prefix_(x_, sums_); }

  kernels::PrefixScan prefix_;
  sk::Stream<std::int32_t> x_, sums_;
};

}  // namespace

Problem scanProblem(int log2) {
  Problem p = grid(log2);
  p.ints.emplace_back();
  for (const float value : numbers(p.size(), 1, 0, 4)) p.ints[0].push_back(static_cast<std::int32_t>(value));
  return p;
}

// Sums of more than 24 bits lose their last ones as floats.
Check scanCheck(const Problem& p) {
  Check check{{}, {}, 0x1p-23};
  double sum = 0;
  for (const std::int32_t value : p.ints[0]) {
    check.values.push_back(sum);
    sum += value;
  }
  return check;
}

std::unique_ptr<Task> scanOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Scan>(device, options, p);
}

}  // namespace race
