// SPDX-License-Identifier: MIT
//
// Methods of conjugate gradients.
#include <algorithm>
#include <utility>

#include "krylov.sk.hpp"
#include "method.hpp"
#include "vectors.sk.hpp"

namespace sk::linear {

namespace {

/// M. Hestenes and E. Stiefel, "Methods of conjugate gradients for solving linear systems" (1952), preconditioned. p . A p is folded
/// where A p is computed, and r . r where r is.
class ConjugateGradients : public Method {
 public:
  explicit ConjugateGradients(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
        p_(vector()),
        q_(vector()),
        rz_(sum()),
        next_(sum()),
        pq_(sum()),
        folded_(sum()) {
    if (parts.preconditioner != nullptr) z_ = vector();
  }

 private:
  void start() override {
    dot.with(foldOptions_)(r_, r_, rr_);
    precondition(r_, p_, rz_);
  }

  void iterate() override {
    matrix_.multiply(p_, q_, pq_);
    const bool isPlain = preconditioner_ == nullptr;
    cgStep.with(foldOptions_)(rz_, pq_, p_, q_, x_, r_, x_, r_, isPlain ? next_ : folded_);
    if (!isPlain) preconditioner_->apply(r_, z_, next_);
    cgDirection.with(options_)(next_, rz_, isPlain ? r_ : z_, p_, p_);
    cgCheck.with(options_)(limit_, isPlain ? next_ : folded_, pq_, next_, rr_, state_, done_);
    std::swap(rz_, next_);
  }

  Vector z_, p_, q_, rz_, next_, pq_, folded_;
};

/// The same without a preconditioner, in two passes, for matrices that are not stored.
class FusedConjugateGradients : public Method {
 public:
  explicit FusedConjugateGradients(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
        p_(vector()),
        now_(sum()),
        before_(sum()),
        next_(sum()),
        pq_(sum()) {}

 private:
  void start() override {
    p_.fill(0.0f);
    before_.fill(0.0f);
    dot.with(foldOptions_)(r_, r_, now_);
    now_.copyTo(rr_);
  }

  void iterate() override {
    matrix_.fusedDirection(now_, before_, r_, p_, pq_);
    matrix_.fusedStep(now_, pq_, p_, x_, r_, next_);
    cgCheck.with(options_)(limit_, next_, pq_, next_, rr_, state_, done_);
    std::swap(before_, now_);
    std::swap(now_, next_);
  }

  Vector p_, now_, before_, next_, pq_;
};

/// P. Ghysels and W. Vanroose, "Hiding global synchronization latency in the preconditioned conjugate gradient algorithm" (2014). Recurrences for A p and its
/// like drift away from what they stand for, so all of them are computed anew from x every `period_` iterations (S. Cools and W. Vanroose, "The
/// communication-hiding pipelined BiCGstab method ...", 2016; the residual replacement of H. van der Vorst and Q. Ye, 2000).
class PipelinedGradients : public Method {
 public:
  explicit PipelinedGradients(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
        b_(vector()),
        w_(vector()),
        n_(vector()),
        z_(vector()),
        s_(vector()),
        p_(vector()),
        folded_(sum()),
        gamma_(sum()),
        next_(sum()),
        delta_(sum()),
        alpha_(sum()),
        alphaNext_(sum()),
        beta_(sum()),
        unused_(sum()) {
    if (isPlain()) return;
    u_ = vector();
    m_ = vector();
    q_ = vector();
  }

  std::int64_t advance(std::int64_t every, std::int64_t most) override {
    const std::int64_t ran = Method::advance(std::min(every, period_), most);
    since_ += ran;
    if (since_ >= period_ && state() == Running) replace();
    return ran;
  }

 private:
  bool hasCycles() const override { return true; }
  bool isPlain() const { return preconditioner_ == nullptr; }

  void start() override {
    r_.copyTo(b_);
    for (Vector* v : {&z_, &s_, &p_}) v->fill(0.0f);
    if (!isPlain()) q_.fill(0.0f);
    since_ = 0;
    gamma_.fill(0.0f);
    alpha_.fill(0.0f);
    auxiliaries();
    check();
  }

  /// u, w and the sums, from r_.
  void auxiliaries() {
    dot.with(foldOptions_)(r_, r_, folded_);
    if (isPlain()) {
      folded_.copyTo(next_);
      return matrix_.multiply(r_, w_, delta_);
    }
    preconditioner_->apply(r_, u_, next_);
    matrix_.multiply(u_, w_, delta_);
  }

  void iterate() override {
    if (isPlain()) {
      matrix_.multiply(w_, n_);
      pipelinedPlainStep.with(foldOptions_)(alpha_, beta_, n_, z_, s_, p_, x_, r_, w_, z_, s_, p_, x_, r_, w_,
                                            folded_, delta_);
      folded_.copyTo(next_);
    } else {
      preconditioner_->apply(w_, m_, unused_);
      matrix_.multiply(m_, n_);
      pipelinedStep.with(foldOptions_)(alpha_, beta_, n_, m_, z_, q_, s_, p_, x_, r_, u_, w_, z_, q_, s_, p_,
                                       x_, r_, u_, w_, folded_, next_, delta_);
    }
    check();
  }

  void check() {
    pipelinedCheck.with(options_)(limit_, folded_, next_, delta_, gamma_, alpha_, alphaNext_, beta_, rr_,
                                  state_, done_);
    next_.copyTo(gamma_);
    alphaNext_.copyTo(alpha_);
  }

  void replace() {
    since_ = 0;
    matrix_.multiply(x_, n_);
    axpy.with(options_)(-1.0f, n_, b_, r_);
    if (isPlain()) {
      matrix_.multiply(r_, w_);
      matrix_.multiply(p_, s_);
      return matrix_.multiply(s_, z_);
    }
    preconditioner_->apply(r_, u_, unused_);
    matrix_.multiply(u_, w_);
    matrix_.multiply(p_, s_);
    preconditioner_->apply(s_, q_, unused_);
    matrix_.multiply(q_, z_);
  }

  Vector b_, u_, w_, m_, n_, z_, q_, s_, p_;
  Vector folded_, gamma_, next_, delta_, alpha_, alphaNext_, beta_, unused_;
  const std::int64_t period_ = arithmetic_.roundoff() > 0x1p-40 ? 16 : 64;
  std::int64_t since_ = 0;
};

}  // namespace

std::unique_ptr<Method> makeGradients(const MethodParts& parts) {
  if (parts.preconditioner == nullptr && parts.matrix.isFused())
    return std::make_unique<FusedConjugateGradients>(parts);
  return std::make_unique<ConjugateGradients>(parts);
}

std::unique_ptr<Method> makePipelinedGradients(const MethodParts& parts) {
  return std::make_unique<PipelinedGradients>(parts);
}

}  // namespace sk::linear
