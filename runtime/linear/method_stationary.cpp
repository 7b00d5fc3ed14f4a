// SPDX-License-Identifier: MIT
//
// Methods without scalar products in their steps: stationary iterations, over-relaxation, and Chebyshev's iteration.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "eigenvalues.hpp"
#include "krylov.sk.hpp"
#include "method.hpp"
#include "operator.hpp"
#include "relaxation.hpp"
#include "vectors.sk.hpp"

namespace sk::linear {

namespace {

/// x <- x + M (b - A x): what a preconditioner does by itself.
class Stationary : public Method {
 public:
  explicit Stationary(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
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

/// Successive over-relaxation (D. Young, "Iterative solution of large linear systems", 1971) by colours. The residual that it computes has for each
/// equation what was left when its unknown was relaxed.
class Relaxation : public Method {
 public:
  explicit Relaxation(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
        relaxer_(makeRelaxer(parts.device, parts.matrix, *parts.settings.a, parts.arithmetic)),
        omega_(static_cast<float>(parts.settings.omega)) {}

  const Vector& x() override {
    relaxer_->store(x_);
    return x_;
  }

 private:
  void start() override {
    dot.with(foldOptions_)(r_, r_, rr_);
    relaxer_->load(r_);
  }

  void iterate() override {
    relaxer_->sweep(omega_, rr_);
    stationaryCheck.with(options_)(limit_, rr_, state_, done_);
  }

  std::unique_ptr<Relaxer> relaxer_;
  float omega_;
};

/// G. Golub and R. Varga, "Chebyshev semi-iterative methods ..." (1961), preconditioned. The extreme eigenvalues come from some steps of conjugate
/// gradients, whose numbers are those of Lanczos's matrix (Saad, "Iterative methods for sparse linear systems", 6.7.3).
class ChebyshevIteration : public Method {
 public:
  explicit ChebyshevIteration(const MethodParts& parts)
      : Method(parts.device, parts.matrix, parts.preconditioner, parts.arithmetic),
        z_(vector()),
        d_(vector()),
        q_(vector()),
        rz_(sum()),
        folded_(sum()),
        rho_(sum()),
        next_(sum()),
        keep_(sum()),
        scale_(sum()) {}

 private:
  static constexpr int most = 200;

  void start() override {
    if (radius_ == 0.0 && !estimate()) return;
    precondition(r_, z_, rz_);
    dot.with(foldOptions_)(r_, r_, rr_);
    chebyshevTurn.with(options_)(0.0f, static_cast<float>(1.0 / centre_), z_, z_, d_);
    rho_.writeReals(std::array{radius_ / centre_});
  }

  void iterate() override {
    matrix_.multiply(d_, q_);
    chebyshevMove.with(foldOptions_)(d_, q_, x_, r_, x_, r_, rr_);
    precondition(r_, z_, rz_);
    chebyshevCheck.with(options_)(static_cast<float>(centre_), static_cast<float>(radius_), limit_, rr_, rho_,
                                  next_, keep_, scale_, state_, done_);
    chebyshevTurn.with(options_)(keep_, scale_, z_, d_, d_);
    std::swap(rho_, next_);
  }

  /// Finds the interval of eigenvalues: until the smallest one that Lanczos's matrix has changes by less than 2 %. Returns false, and sets
  /// the state, if the matrix is not positive definite.
  bool estimate() {
    Vector r = vector();
    r_.copyTo(r);
    precondition(r, z_, rz_);
    z_.copyTo(d_);
    std::vector<double> diagonal, beside;
    double rz = rz_.readReals()[0], before = 0.0, smallest = 0.0;
    for (int k = 0; k < most && rz != 0.0; ++k) {
      matrix_.multiply(d_, q_, folded_);
      const double dq = folded_.readReals()[0];
      if (!(dq > 0.0) || !(rz > 0.0)) {
        state_.fill(std::isfinite(dq) && std::isfinite(rz) ? NotPositive : NotFinite);
        return false;
      }
      const double alpha = rz / dq;
      diagonal.push_back(1.0 / alpha + before);
      if (k % 8 == 7) {
        const double now = tridiagonalEigenvalue(diagonal, beside, true);
        if (now > 0.98 * smallest && k > 8) break;
        smallest = now;
      }
      axpy.with(options_)(static_cast<float>(-alpha), q_, r, r);
      precondition(r, z_, rz_);
      const double next = rz_.readReals()[0], beta = next / rz;
      if (!std::isfinite(next) || next <= 0.0) break;
      beside.push_back(std::sqrt(beta) / alpha);
      before = beta / alpha;
      axpy.with(options_)(static_cast<float>(beta), d_, z_, d_);
      rz = next;
    }
    if (diagonal.empty()) return true;
    beside.resize(diagonal.size() - 1);
    const double low = 0.95 * tridiagonalEigenvalue(diagonal, beside, true);
    const double high = 1.02 * tridiagonalEigenvalue(diagonal, beside, false);
    centre_ = 0.5 * (high + low);
    radius_ = std::max(0.5 * (high - low), 0.01 * high);
    return true;
  }

  Vector z_, d_, q_, rz_, folded_, rho_, next_, keep_, scale_;
  double centre_ = 1.0, radius_ = 0.0;
};

}  // namespace

std::unique_ptr<Method> makeStationary(const MethodParts& parts) {
  return std::make_unique<Stationary>(parts);
}

std::unique_ptr<Method> makeRelaxation(const MethodParts& parts) {
  if (parts.settings.a == nullptr) throw std::logic_error("sor needs the matrix on the host");
  if (!(parts.settings.omega > 0.0 && parts.settings.omega < 2.0))
    throw sk::Error(fmt::format("the relaxation factor {} is not between 0 and 2", parts.settings.omega));
  checkDiagonal(*parts.settings.a, "the solver 'sor'", "the solver 'gmres' and the preconditioner 'none'");
  return std::make_unique<Relaxation>(parts);
}

std::unique_ptr<Method> makeChebyshevIteration(const MethodParts& parts) {
  return std::make_unique<ChebyshevIteration>(parts);
}

}  // namespace sk::linear
