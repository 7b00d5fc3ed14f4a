// SPDX-License-Identifier: MIT
//
// Sorted floats. Ours is a bitonic network; peers sort as they like. floats: keys.
#include <algorithm>

#include "bitonic_sort.sk.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

class Sort final : public OurTask {
 public:
  Sort(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        exchange_(bitonic_sort::exchange.with(options)),
        keys_(filled<float>({p.size()}, p.floats[0])),
        sorted_(device.stream<float>({p.size()})) {}

  std::vector<float> result() override { return sorted_.read(); }

 private:
  void once() override {
    const auto n = static_cast<int>(keys_.size());
    exchange_(1, keys_, sorted_);
    for (int run = 2; run < n; run *= 2) {
      exchange_(2 * run - 1, sorted_, sorted_);
      for (int distance = run / 2; distance > 0; distance /= 2) exchange_(distance, sorted_, sorted_);
    }
  }

  bitonic_sort::ExchangeKernel exchange_;
  sk::Stream<float> keys_, sorted_;
};

}  // namespace

Problem sortProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1, -1000, 1000)};
  return p;
}

Check sortCheck(const Problem& p) {
  std::vector<float> keys = p.floats[0];
  std::sort(keys.begin(), keys.end());
  return {{}, {keys.begin(), keys.end()}, 0};
}

std::unique_ptr<Task> sortOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Sort>(device, options, p);
}

}  // namespace race
