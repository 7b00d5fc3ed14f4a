// SPDX-License-Identifier: MIT
//
// What comes before each element: the exclusive prefix sums of integers, by Blelloch's two ways through a tree. ints: x.
#include <vector>

#include "our_task.hpp"
#include "prefix_scan.sk.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

class Scan final : public OurTask {
 public:
  Scan(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device), pair_(prefix_scan::pair.with(options)), spread_(prefix_scan::spread.with(options)) {
    sums_.push_back(filled<std::int32_t>({p.size()}, p.ints[0]));
    before_.push_back(device.stream<std::int32_t>({p.size()}));
    while (sums_.back().size() > 1) {
      const std::int64_t half = (sums_.back().size() + 1) / 2;
      sums_.push_back(device.stream<std::int32_t>({half}));
      before_.push_back(device.stream<std::int32_t>({half}));
    }
    before_.back().write(std::vector<std::int32_t>{0});
  }

  std::vector<float> result() override {
    const std::vector<std::int32_t> sums = before_.front().read();
    return {sums.begin(), sums.end()};
  }

 private:
  void once() override {
    for (std::size_t level = 0; level + 1 < sums_.size(); ++level) pair_(sums_[level], sums_[level + 1]);
    for (std::size_t level = sums_.size() - 1; level-- > 0;) {
      spread_(before_[level + 1], sums_[level], before_[level]);
    }
  }

  prefix_scan::PairKernel pair_;
  prefix_scan::SpreadKernel spread_;
  std::vector<sk::Stream<std::int32_t>> sums_, before_;
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
