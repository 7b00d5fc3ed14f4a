// SPDX-License-Identifier: MIT
//
// r = a x + y, of two arrays. floats: x, y.
#include "programs/saxpy.sk.hpp"

#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

class Saxpy final : public OurTask {
 public:
  Saxpy(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        saxpy_(kernels::saxpy.with(options)),
        x_(filled<float>({p.size()}, p.floats[0])),
        y_(filled<float>({p.size()}, p.floats[1])),
        r_(device.stream<float>({p.size()})) {}

  std::vector<float> result() override { return r_.read(); }

 private:
  void once() override { saxpy_(saxpyFactor, x_, y_, r_); }

  kernels::SaxpyKernel saxpy_;
  sk::Stream<float> x_, y_, r_;
};

}  // namespace

Problem saxpyProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.size(), 2)};
  return p;
}

Check saxpyCheck(const Problem& p) {
  Check check{somePlaces(p.size()), {}, 0x1p-22};
  for (const std::int64_t i : check.places) {
    const auto at = static_cast<std::size_t>(i);
    check.values.push_back(double{saxpyFactor} * p.floats[0][at] + p.floats[1][at]);
  }
  return check;
}

std::unique_ptr<Task> saxpyOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Saxpy>(device, options, p);
}

}  // namespace race
