// SPDX-License-Identifier: MIT
#include "method.hpp"

#include <array>
#include <utility>

#include "vectors.sk.hpp"

namespace linear {

Method::Method(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
               const Arithmetic& arithmetic)
    : device_(device),
      matrix_(matrix),
      preconditioner_(preconditioner),
      arithmetic_(arithmetic),
      options_(arithmetic.options()),
      foldOptions_(arithmetic.foldOptions()),
      x_(vector()),
      r_(vector()),
      rr_(sum()),
      limit_(sum()),
      state_(device.stream<int>({1})),
      done_(device.stream<bool>({1})) {}

void Method::begin(std::span<const double> rightHandSide, double limit) {
  r_.writeReals(rightHandSide);
  startWithin(limit);
}

void Method::begin(const Vector& rightHandSide, double limit) {
  rightHandSide.copyTo(r_);
  startWithin(limit);
}

void Method::startWithin(double limit) {
  x_.fill(0.0f);
  limit_.writeReals(std::array{limit});
  state_.fill(Running);
  start();
}

std::int64_t Method::run(std::int64_t every, std::int64_t most) {
  if (!loop_) loop_ = device_.record([&] { iterate(); });
  return loop_.until(done_, {.every = every, .most = most});
}

State Method::state() const { return static_cast<State>(state_.read()[0]); }

double Method::residualSquared() const { return rr_.readReals()[0]; }

void Method::precondition(const Vector& r, Vector& z, Vector& rz) {
  if (preconditioner_ != nullptr) return preconditioner_->apply(r, z, rz);
  r.copyTo(z);
  dot.with(foldOptions_)(r, z, rz);
}

namespace {

/// M. Hestenes and E. Stiefel, "Methods of conjugate gradients for solving linear systems" (1952), preconditioned. p . A p is folded
/// where A p is computed, and r . r where r is.
class ConjugateGradients : public Method {
 public:
  ConjugateGradients(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
                     const Arithmetic& arithmetic)
      : Method(device, matrix, preconditioner, arithmetic),
        p_(vector()),
        q_(vector()),
        rz_(sum()),
        next_(sum()),
        pq_(sum()),
        folded_(sum()) {
    if (preconditioner != nullptr) z_ = vector();
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
  FusedConjugateGradients(sk::Device& device, Matrix& matrix, const Arithmetic& arithmetic)
      : Method(device, matrix, nullptr, arithmetic),
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

/// x <- x + M (b - A x): what a preconditioner does by itself.
class Stationary : public Method {
 public:
  Stationary(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner, const Arithmetic& arithmetic)
      : Method(device, matrix, preconditioner, arithmetic),
        b_(vector()),
        z_(vector()),
        q_(vector()),
        rz_(sum()) {}

  /// Its residual is that of x, which its precision limits, and becomes smaller in each iteration before that.
  std::int64_t patience() const override { return 32; }

 private:
  void start() override {
    r_.copyTo(b_);
    dot.with(foldOptions_)(r_, r_, rr_);
  }

  void iterate() override {
    precondition(r_, z_, rz_);
    axpy.with(options_)(1.0f, z_, x_, x_);
    matrix_.multiply(x_, q_);
    subtractFrom.with(foldOptions_)(b_, q_, r_, rr_);
    stationaryCheck.with(options_)(limit_, rr_, state_, done_);
  }

  Vector b_, z_, q_, rz_;
};

/// C. Paige and M. Saunders, "Solution of sparse indefinite systems of linear equations" (1975), with a positive definite
/// preconditioner M (H. Elman, D. Silvester and A. Wathen, "Finite elements and fast iterative solvers", algorithm 4.1). The residual that it computes
/// is measured by r . M r.
class MinimalResiduals : public Method {
 public:
  MinimalResiduals(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
                   const Arithmetic& arithmetic)
      : Method(device, matrix, preconditioner, arithmetic),
        z_(vector()),
        zNext_(vector()),
        q_(vector()),
        vBefore_(vector()),
        vNext_(vector()),
        w_(vector()),
        wBefore_(vector()),
        zq_(sum()),
        vz_(sum()),
        numbers_(device.stream<Minres>({1}, arithmetic.sums())),
        turned_(device.stream<Minres>({1}, arithmetic.sums())) {}

 private:
  void start() override {
    for (Vector* v : {&vBefore_, &w_, &wBefore_}) v->fill(0.0f);
    precondition(r_, z_, vz_);
    minresStart.with(options_)(vz_, numbers_, rr_);
  }

  /// r_ is v of this step.
  void iterate() override {
    matrix_.multiply(z_, q_, zq_);
    minresLanczos.with(options_)(numbers_, zq_, q_, r_, vBefore_, vNext_);
    precondition(vNext_, zNext_, vz_);
    minresRotate.with(options_)(limit_, numbers_, zq_, vz_, turned_, rr_, state_, done_);
    minresStep.with(options_)(numbers_, turned_, z_, w_, wBefore_, x_, wBefore_, x_);
    std::swap(w_, wBefore_);
    std::swap(vBefore_, r_);
    std::swap(r_, vNext_);
    std::swap(z_, zNext_);
    std::swap(numbers_, turned_);
  }

  Vector z_, zNext_, q_, vBefore_, vNext_, w_, wBefore_, zq_, vz_;
  sk::Stream<Minres> numbers_, turned_;
};

/// H. van der Vorst, "Bi-CGSTAB: a fast and smoothly converging variant of Bi-CG for the solution of nonsymmetric linear systems"
/// (1992), preconditioned from the right.
class BiconjugateGradients : public Method {
 public:
  BiconjugateGradients(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
                       const Arithmetic& arithmetic)
      : Method(device, matrix, preconditioner, arithmetic),
        shadow_(vector()),
        p_(vector()),
        v_(vector()),
        s_(vector()),
        t_(vector()),
        rho_(sum()),
        next_(sum()),
        sv_(sum()),
        ts_(sum()),
        tt_(sum()),
        unused_(sum()) {
    if (preconditioner != nullptr) {
      pz_ = vector();
      sz_ = vector();
    }
  }

 private:
  void start() override {
    r_.copyTo(shadow_);
    r_.copyTo(p_);
    dot.with(foldOptions_)(r_, r_, rr_);
    rr_.copyTo(rho_);
  }

  void iterate() override {
    const bool isPlain = preconditioner_ == nullptr;
    if (!isPlain) preconditioner_->apply(p_, pz_, unused_);
    const Vector& p = isPlain ? p_ : pz_;
    matrix_.multiply(p, v_);
    dot.with(foldOptions_)(shadow_, v_, sv_);
    bicgHalf.with(options_)(rho_, sv_, r_, v_, s_);
    if (!isPlain) preconditioner_->apply(s_, sz_, unused_);
    const Vector& z = isPlain ? s_ : sz_;
    matrix_.multiply(z, t_);
    dots.with(foldOptions_)(s_, t_, ts_, tt_);
    bicgStep.with(foldOptions_)(rho_, sv_, ts_, tt_, p, z, s_, t_, shadow_, x_, x_, r_, rr_, next_);
    bicgDirection.with(options_)(next_, sv_, ts_, tt_, r_, p_, v_, p_);
    bicgCheck.with(options_)(limit_, rr_, next_, sv_, tt_, state_, done_);
    std::swap(rho_, next_);
  }

  Vector shadow_, p_, v_, s_, t_, pz_, sz_;
  Vector rho_, next_, sv_, ts_, tt_, unused_;
};

template <class M>
std::unique_ptr<Method> make(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
                             const Arithmetic& arithmetic) {
  return std::make_unique<M>(device, matrix, preconditioner, arithmetic);
}

std::unique_ptr<Method> makeGradients(sk::Device& device, Matrix& matrix, Preconditioner* preconditioner,
                                      const Arithmetic& arithmetic) {
  if (preconditioner == nullptr && matrix.isFused())
    return std::make_unique<FusedConjugateGradients>(device, matrix, arithmetic);
  return std::make_unique<ConjugateGradients>(device, matrix, preconditioner, arithmetic);
}

constexpr MethodKind methods[] = {
    {"cg", "conjugate gradients, for symmetric positive definite matrices", true, makeGradients},
    {"minres", "minimal residuals, for symmetric matrices that are not definite", true,
     make<MinimalResiduals>},
    {"stationary", "x + M (b - A x): the preconditioner by itself", false, make<Stationary>},
    {"bicgstab", "stabilised biconjugate gradients, for any matrix", false, make<BiconjugateGradients>},
};

}  // namespace

std::span<const MethodKind> methodKinds() { return methods; }

}  // namespace linear
