// SPDX-License-Identifier: MIT
//
// Reductions to one number: a sum, the same with what each addition loses carried beside it, and a dot product.
// floats: x, and for the dot product y.
#include "programs/sums.sk.hpp"

#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

sk::CallOptions with(sk::CallOptions options, sk::Accumulate accumulate) {
  options.accumulate = accumulate;
  return options;
}

class Sum final : public OurTask {
 public:
  Sum(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device), sum_(kernels::sum.with(options)), x_(filled<float>({p.size()}, p.floats[0])) {}

  std::vector<float> result() override { return {total_}; }

 private:
  void once() override { total_ = sum_(x_); }

  kernels::SumReduce sum_;
  sk::Stream<float> x_;
  float total_ = 0;
};

class Dot final : public OurTask {
 public:
  Dot(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        dot_(kernels::dot.with(options)),
        x_(filled<float>({p.size()}, p.floats[0])),
        y_(filled<float>({p.size()}, p.floats[1])) {}

  std::vector<float> result() override { return {total_}; }

 private:
  void once() override { total_ = dot_(x_, y_); }

  kernels::DotReduce dot_;
  sk::Stream<float> x_, y_;
  float total_ = 0;
};

/// The sum itself, as far as doubles hold it.
double sumOf(const std::vector<float>& x) {
  double sum = 0;
  for (const float value : x) sum += value;
  return sum;
}

}  // namespace

Problem sumProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1)};
  return p;
}

// What additions lose that keep no account of it, in as few chains as a contender has vector lanes.
Check sumCheck(const Problem& p) { return {{}, {sumOf(p.floats[0])}, 1e-3}; }

Check compensatedSumCheck(const Problem& p) { return {{}, {sumOf(p.floats[0])}, 0x1p-22}; }

std::unique_ptr<Task> sumOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Sum>(device, with(options, sk::Accumulate::Tree), p);
}

std::unique_ptr<Task> compensatedSumOurs(sk::Device& device, const sk::CallOptions& options,
                                         const Problem& p) {
  return std::make_unique<Sum>(device, with(options, sk::Accumulate::Compensated), p);
}

Problem dotProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.size(), 2)};
  return p;
}

Check dotCheck(const Problem& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.floats[0].size(); ++i) sum += double{p.floats[0][i]} * p.floats[1][i];
  return {{}, {sum}, 1e-3};
}

std::unique_ptr<Task> dotOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Dot>(device, with(options, sk::Accumulate::Tree), p);
}

}  // namespace race
