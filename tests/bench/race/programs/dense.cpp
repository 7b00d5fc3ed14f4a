// SPDX-License-Identifier: MIT
//
// y = A x and C = A B. floats: A, and x or B, which is a square as wide as A.
#include "programs/dense.sk.hpp"

#include "our_task.hpp"
#include "programs/all.hpp"
#include "sgemm.sk.hpp"

namespace race {
namespace {

class Gemv final : public OurTask {
 public:
  Gemv(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        gemv_(kernels::gemv.with(options)),
        a_(filled<float>({p.rows, p.columns}, p.floats[0])),
        x_(filled<float>({p.columns}, p.floats[1])),
        y_(device.stream<float>({p.rows})) {}

  std::vector<float> result() override { return y_.read(); }

 private:
  void once() override { gemv_(a_, x_, y_); }

  kernels::GemvKernel gemv_;
  sk::Stream<float> a_, x_, y_;
};

/// A reduce of the rows. Sums are plain, as the peers' are.
class GemvInRows final : public OurTask {
 public:
  GemvInRows(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        gemv_(kernels::gemvRow.with(options).with({.accumulate = sk::Accumulate::Tree})),
        a_(filled<float>({p.rows, p.columns}, p.floats[0])),
        x_(filled<float>({1, p.columns}, p.floats[1])),
        y_(device.stream<float>({p.rows, 1})) {}

  std::vector<float> result() override { return y_.read(); }

 private:
  void once() override { gemv_(a_, x_, y_); }

  kernels::GemvRowReduce gemv_;
  sk::Stream<float> a_, x_, y_;
};

/// As one writes it down: native code computes several rows together.
class Gemm final : public OurTask {
 public:
  Gemm(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        gemm_(kernels::gemm.with(options)),
        a_(filled<float>({p.rows, p.columns}, p.floats[0])),
        b_(filled<float>({p.columns, p.columns}, p.floats[1])),
        c_(device.stream<float>({p.rows, p.columns})) {}

  std::vector<float> result() override { return c_.read(); }

 private:
  void once() override { gemm_(a_, b_, c_); }

  kernels::GemmKernel gemm_;
  sk::Stream<float> a_, b_, c_;
};

/// In blocks of 2 x 2, which packing and unpacking make: a part of the work. A fetch of a texel then serves two products.
class GemmInBlocks final : public OurTask {
 public:
  GemmInBlocks(sk::Device& device, const sk::CallOptions& options, const Problem& p)
      : OurTask(device),
        pack_(sgemm::pack.with(options)),
        multiply_(sgemm::multiply.with(options)),
        unpack_(sgemm::unpack.with(options)),
        inner_(static_cast<int>(p.columns / 2)),
        a_(filled<float>({p.rows, p.columns}, p.floats[0])),
        b_(filled<float>({p.columns, p.columns}, p.floats[1])),
        c_(device.stream<float>({p.rows, p.columns})),
        zeros_(filled<sk::float4>({p.rows / 2, p.columns / 2},
                                  std::vector<sk::float4>(static_cast<std::size_t>(p.size() / 4)))),
        aBlocks_(device.stream<sk::float4>({p.rows / 2, p.columns / 2})),
        bBlocks_(device.stream<sk::float4>({p.columns / 2, p.columns / 2})),
        cBlocks_(device.stream<sk::float4>({p.rows / 2, p.columns / 2})) {}

  std::vector<float> result() override { return c_.read(); }

 private:
  void once() override {
    pack_(a_, aBlocks_);
    pack_(b_, bBlocks_);
    multiply_(0, inner_, aBlocks_, bBlocks_, zeros_, cBlocks_);
    unpack_(cBlocks_, c_);
  }

  sgemm::PackKernel pack_;
  sgemm::MultiplyKernel multiply_;
  sgemm::UnpackKernel unpack_;
  int inner_;
  sk::Stream<float> a_, b_, c_;
  sk::Stream<sk::float4> zeros_, aBlocks_, bBlocks_, cBlocks_;
};

}  // namespace

Problem gemvProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.columns, 2)};
  return p;
}

Check gemvCheck(const Problem& p) {
  Check check{{}, {}, 1e-5};
  const float* a = p.floats[0].data();
  for (std::int64_t row = 0; row < p.rows; ++row) {
    double dot = 0;
    for (const float x : p.floats[1]) dot += double{*a++} * x;
    check.values.push_back(dot);
  }
  return check;
}

std::unique_ptr<Task> gemvOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  // in software, a pass costs as much as some thousand elements
  if (device.isSoftware() && device.profile() != "native") return std::make_unique<Gemv>(device, options, p);
  return std::make_unique<GemvInRows>(device, options, p);
}

Problem gemmProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 1), numbers(p.columns * p.columns, 2)};
  return p;
}

Check gemmCheck(const Problem& p) {
  Check check{somePlaces(p.size()), {}, 1e-5};
  for (const std::int64_t i : check.places) {
    double dot = 0;
    for (std::int64_t k = 0; k < p.columns; ++k) {
      dot += double{p.floats[0][static_cast<std::size_t>(i / p.columns * p.columns + k)]} *
             p.floats[1][static_cast<std::size_t>(k * p.columns + i % p.columns)];
    }
    check.values.push_back(dot);
  }
  return check;
}

std::unique_ptr<Task> gemmOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  if (device.profile() == "native") return std::make_unique<Gemm>(device, options, p);
  return std::make_unique<GemmInBlocks>(device, options, p);
}

}  // namespace race
