// SPDX-License-Identifier: MIT
//
// Methods for matrices that are not positive definite, or not symmetric.
#include <algorithm>
#include <utility>
#include <vector>

#include "krylov.sk.hpp"
#include "method.hpp"
#include "residual.sk.hpp"
#include "vectors.sk.hpp"

namespace sk::linear {

namespace {

/// C. Paige and M. Saunders, "Solution of sparse indefinite systems of linear equations" (1975), with a positive definite
/// preconditioner M (H. Elman, D. Silvester and A. Wathen, "Finite elements and fast iterative solvers", algorithm 4.1). The residual that it computes
/// is measured by r . M r.
class MinimalResiduals : public Method {
 public:
  explicit MinimalResiduals(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
        z_(vector()),
        zNext_(vector()),
        q_(vector()),
        vBefore_(vector()),
        vNext_(vector()),
        w_(vector()),
        wBefore_(vector()),
        zq_(sum()),
        vz_(sum()),
        numbers_(parts.device.stream<Minres>({1}, parts.arithmetic.sums())),
        turned_(parts.device.stream<Minres>({1}, parts.arithmetic.sums())) {}

 private:
  void start() override {
    for (Vector* v : {&vBefore_, &w_, &wBefore_}) v->fill(0.0f);
    precondition(r_, z_, vz_);
    minresStart.with(options_)(vz_, numbers_, rr_, state_);
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
/// (1992), preconditioned from the right. The shadow vector is random, as in P. Sonneveld and M. van Gijzen, "IDR(s)" (2008). The customary one, r itself, is
/// almost orthogonal to the vectors that matter where r lies at the inflow of a convection: residuals of millions of ||b|| follow, and leave nothing of x in floats.
class BiconjugateGradients : public Method {
 public:
  explicit BiconjugateGradients(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
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
    if (parts.preconditioner != nullptr) {
      pz_ = vector();
      sz_ = vector();
    }
  }

  int attempts() const override { return 3; }

 private:
  void start() override {
    randomNumbers.with(options_)(++starts_, shadow_);
    r_.copyTo(p_);
    dots.with(foldOptions_)(shadow_, r_, rho_, rr_);
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
    bicgCheck.with(options_)(limit_, rr_, next_, sv_, ts_, tt_, state_, done_);
    std::swap(rho_, next_);
  }

  int starts_ = 0;

  Vector shadow_, p_, v_, s_, t_, pz_, sz_;
  Vector rho_, next_, sv_, ts_, tt_, unused_;
};

/// Y. Saad and M. Schultz, "GMRES: a generalized minimal residual algorithm for solving nonsymmetric linear systems" (1986), preconditioned from
/// the right. Each modified Gram-Schmidt step folds the next scalar product. The loop on the device repeats a whole cycle of steps.
class GeneralizedMinimalResiduals : public Method {
 public:
  explicit GeneralizedMinimalResiduals(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
        restart_(static_cast<int>(std::min<std::int64_t>(parts.settings.restart, r_.size()))),
        b_(vector()),
        w_(vector()),
        u_(vector()),
        z_(vector()),
        h_(parts.device.stream<float>({restart_ + 1}, arithmetic_.sums())),
        y_(parts.device.stream<float>({restart_ + 1}, arithmetic_.sums())),
        turns_(parts.device.stream<Turn>({restart_ + 1}, arithmetic_.sums())),
        turned_(parts.device.stream<Turn>({restart_ + 1}, arithmetic_.sums())),
        steps_(parts.device.stream<int>({1}, Storage::Default, "sk::linear steps")),
        residual_(sum()),
        unused_(sum()) {
    for (int j = 0; j <= restart_; ++j) basis_.push_back(vector());
    for (int j = 0; j < restart_; ++j)
      columns_.push_back(parts.device.stream<float>({restart_ + 1}, arithmetic_.sums()));
  }

  std::int64_t advance(std::int64_t, std::int64_t most) override {
    steps_.fill(0);
    if (isDivided()) {
      cycle(static_cast<int>(std::min<std::int64_t>(most, restart_)));
    } else if (most < restart_) {
      device_.record([&] { cycle(static_cast<int>(most)); }).repeat(1);
    } else {
      if (!cycle_) cycle_ = device_.record([&] { iterate(); });
      cycle_.repeat(1);
    }
    return steps_.read()[0];
  }

 private:
  void start() override {
    r_.copyTo(b_);
    dot.with(foldOptions_)(r_, r_, residual_);
    residual_.copyTo(rr_);
  }

  void iterate() override { cycle(restart_); }
  bool hasCycles() const override { return true; }

  void cycle(int steps) {
    gmresNormalise.with(options_)(residual_, r_, basis_[0]);
    gmresBegin.with(options_)(residual_, turns_);
    for (int j = 0; j < steps; ++j) step(static_cast<std::size_t>(j));
    gmresRightHandSide.with(options_)(turns_, y_);
    for (int k = steps - 1; k >= 0; --k)
      gmresSubstitute.with(options_)(k, columns_[static_cast<std::size_t>(k)], y_, y_);
    combine(steps);
    matrix_.multiply(x_, w_);
    subtractFrom.with(foldOptions_)(b_, w_, r_, residual_);
  }

  void step(std::size_t j) {
    const auto h = [&](std::size_t k) {
      const auto at = static_cast<std::int64_t>(k);
      return h_.domain({at}, {at + 1});
    };
    if (preconditioner_ != nullptr) preconditioner_->apply(basis_[j], z_, unused_);
    matrix_.multiply(preconditioner_ != nullptr ? z_ : basis_[j], w_);
    dot.with(foldOptions_)(w_, basis_[0], h(0));
    for (std::size_t k = 0; k < j; ++k)
      gmresOrthogonalise.with(foldOptions_)(h(k), basis_[k], basis_[k + 1], w_, w_, h(k + 1));
    gmresLast.with(foldOptions_)(h(j), basis_[j], w_, w_, h(j + 1));
    gmresNormalise.with(options_)(h(j + 1), w_, basis_[j + 1]);
    gmresRotate.with(options_)(static_cast<int>(j), h_, turns_, turned_, columns_[j]);
    std::swap(turns_, turned_);
    gmresCheck.with(options_)(static_cast<int>(j), limit_, turns_, h_, steps_, state_, rr_, steps_, rr_,
                              state_, done_);
  }

  /// x_ += M (sum of y[k] basis_[k])
  void combine(int steps) {
    u_.fill(0.0f);
    int k = 0;
    for (; k + 4 <= steps; k += 4) {
      const Vector* v = &basis_[static_cast<std::size_t>(k)];
      gmresCombine4.with(options_)(k, y_, v[0], v[1], v[2], v[3], u_, u_);
    }
    for (; k < steps; ++k) gmresCombine.with(options_)(k, y_, basis_[static_cast<std::size_t>(k)], u_, u_);
    if (preconditioner_ != nullptr) preconditioner_->apply(u_, z_, unused_);
    axpy.with(options_)(1.0f, preconditioner_ != nullptr ? z_ : u_, x_, x_);
  }

  int restart_;
  Vector b_, w_, u_, z_;
  std::vector<Vector> basis_, columns_;
  Vector h_, y_;
  sk::Stream<Turn> turns_, turned_;
  sk::Stream<int> steps_;
  Vector residual_, unused_;
  sk::Loop cycle_;
};

}  // namespace

std::unique_ptr<Method> makeMinimalResiduals(const MethodParts& parts) {
  return std::make_unique<MinimalResiduals>(parts);
}

std::unique_ptr<Method> makeBiconjugateGradients(const MethodParts& parts) {
  return std::make_unique<BiconjugateGradients>(parts);
}

std::unique_ptr<Method> makeGeneralizedMinimalResiduals(const MethodParts& parts) {
  return std::make_unique<GeneralizedMinimalResiduals>(parts);
}

}  // namespace sk::linear
