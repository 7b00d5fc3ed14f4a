// SPDX-License-Identifier: MIT
//
// The positive ones of random numbers, about half of them, in order. floats: x.
#include <algorithm>
#include <iterator>

#include "our_task.hpp"
#include "programs/all.hpp"
#include "programs/compaction.sk.hpp"

namespace race {
namespace {

class Compaction final : public OurTask {
 public:
  Compaction(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        keepPositive_(kernels::keepPositive.with(options)),
        x_(filled<float>({p.size()}, p.floats[0])),
        kept_(device.stream<float>({0})) {}

  std::vector<float> result() override { return kept_.read(); }

 private:
  void once() override { keepPositive_(x_, kept_); }

  kernels::KeepPositive keepPositive_;
  sk::Stream<float> x_, kept_;
};

}  // namespace

Problem compactionProblem(int log2) {
  Problem p = grid(log2);
  p.floats.push_back(numbers(p.size(), 1, -1, 1));
  return p;
}

Check compactionCheck(const Problem& p) {
  Check check{{}, {}, 0};
  std::ranges::copy_if(p.floats[0], std::back_inserter(check.values), [](float x) { return x > 0; });
  return check;
}

std::unique_ptr<Task> compactionOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Compaction>(device, options, p);
}

}  // namespace race
