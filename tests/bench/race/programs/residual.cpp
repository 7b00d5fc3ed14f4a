// SPDX-License-Identifier: MIT
//
// A step of conjugate gradients: the new residual, and the sum of its squares, which stays on the device. floats: q, r.
#include "programs/residual.sk.hpp"

#include "constants.hpp"
#include "our_task.hpp"
#include "programs/all.hpp"

namespace race {
namespace {

sk::CallOptions plain(sk::CallOptions options) {
  options.accumulate = sk::Accumulate::Tree;
  return options;
}

class ResidualTask : public OurTask {
 public:
  /// The residual, and behind it the mean of its squares.
  std::vector<float> result() override {
    std::vector<float> all = rn_.read();
    all.push_back(rr_.read() / static_cast<float>(rn_.size()));
    return all;
  }

 protected:
  ResidualTask(sk::Device& device, const Problem& p)
      : OurTask(device),
        q_(filled<float>({p.size()}, p.floats[0])),
        r_(filled<float>({p.size()}, p.floats[1])),
        rn_(device.stream<float>({p.size()})),
        rr_(device.scalar<float>()) {}

  sk::Stream<float> q_, r_, rn_;
  sk::Scalar<float> rr_;
};

class Residual final : public ResidualTask {
 public:
  Residual(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : ResidualTask(device, p), residual_(kernels::residual.with(plain(options))) {}

 private:
  void once() override { residual_(residualStep, q_, r_, rn_, rr_); }

  kernels::ResidualKernel residual_;
};

class ResidualInTwoCalls final : public ResidualTask {
 public:
  ResidualInTwoCalls(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : ResidualTask(device, p),
        residual_(kernels::residualAlone.with(options)),
        squares_(kernels::squares.with(plain(options))) {}

 private:
  void once() override {
    residual_(residualStep, q_, r_, rn_);
    squares_(rn_, rr_);
  }

  kernels::ResidualAloneKernel residual_;
  kernels::SquaresReduce squares_;
};

}  // namespace

Problem residualProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.size(), 2)};
  return p;
}

Check residualCheck(const Problem& p) {
  Check check{somePlaces(p.size()), {}, 1e-3};
  const auto at = [&](std::int64_t i) {
    return p.floats[1][static_cast<std::size_t>(i)] -
           double{residualStep} * p.floats[0][static_cast<std::size_t>(i)];
  };
  for (const std::int64_t place : check.places) check.values.push_back(at(place));
  double square = 0;
  for (std::int64_t i = 0; i < p.size(); ++i) square += at(i) * at(i);
  check.places.push_back(p.size());
  check.values.push_back(square / static_cast<double>(p.size()));
  return check;
}

std::unique_ptr<Task> residualOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  return std::make_unique<Residual>(device, options, p);
}

std::unique_ptr<Task> residualInTwoCalls(sk::Device& device, const sk::CallOptions& options,
                                         const Problem& p) {
  return std::make_unique<ResidualInTwoCalls>(device, options, p);
}

}  // namespace race
