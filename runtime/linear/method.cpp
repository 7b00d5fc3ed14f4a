// SPDX-License-Identifier: MIT
#include "method.hpp"

#include <algorithm>
#include <array>

#include "vectors.sk.hpp"

namespace sk::linear {

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
      state_(device.stream<int>({1}, Storage::Default,
                                "sk::linear state")),  // no result of the application (SK_RESULTS)
      done_(device.stream<bool>({1}, Storage::Default, "sk::linear done")) {}

void Method::begin(std::span<const double> rightHandSide, double limit) {
  r_.writeReals(rightHandSide);
  begin(limit);
}

void Method::begin(const Vector& rightHandSide, double limit) {
  rightHandSide.copyTo(r_);
  begin(limit);
}

void Method::begin(double limit) {
  x_.fill(0.0f);
  limit_.writeReals(std::array{limit});
  state_.fill(Running);
  start();
}

std::int64_t Method::run(std::int64_t every, std::int64_t most) {
  if (!hasCycles()) return repeat(every, most);
  std::int64_t ran = 0;
  while (ran < most) {
    const std::int64_t now = advance(every, most - ran);
    ran += now;
    if (now == 0 || state() != Running) break;
  }
  return ran;
}

std::int64_t Method::advance(std::int64_t every, std::int64_t most) {
  return repeat(every, std::min(every, most));
}

std::int64_t Method::repeat(std::int64_t every, std::int64_t most) {
  if (isDivided()) return repeatAtOnce(most);
  if (!loop_) loop_ = device_.record([&] { iterate(); });
  return loop_.until(done_, {.every = every, .most = most});
}

/// What a loop does, call by call. The sums of all ranks have passed through the host, so that asking it after each iteration costs little.
std::int64_t Method::repeatAtOnce(std::int64_t most) {
  std::int64_t ran = 0;
  bool isDone = false;
  while (ran < most && !isDone) {
    iterate();
    ++ran;
    isDone = done_.read()[0] != 0;
  }
  return ran;
}

void Method::keep() {
  if (!kept_) kept_ = vector();
  x_.copyTo(kept_);
}

State Method::state() const { return static_cast<State>(state_.read()[0]); }

double Method::residualSquared() const { return rr_.readReals()[0]; }

void Method::precondition(const Vector& r, Vector& z, Vector& rz) {
  if (preconditioner_ != nullptr) return preconditioner_->apply(r, z, rz);
  r.copyTo(z);
  dot.with(foldOptions_)(r, z, rz);
}

namespace {

constexpr MethodKind methods[] = {
    {"cg", "conjugate gradients, for symmetric positive definite matrices", true, 5, makeGradients},
    {"pipelined", "conjugate gradients with one pass over all vectors in an iteration", true, 11,
     makePipelinedGradients},
    {"chebyshev", "Chebyshev's iteration, without scalar products, for the matrices of cg", true, 6,
     makeChebyshevIteration, false, false},
    {"minres", "minimal residuals, for symmetric matrices that are not definite", true, 9,
     makeMinimalResiduals},
    {"stationary", "x + M (b - A x): the preconditioner by itself", false, 5, makeStationary},
    {"sor", "successive over-relaxation by colours; Gauss-Seidel's iteration for --omega 1", false, 5,
     makeRelaxation, false, false},
    {"bicgstab", "stabilised biconjugate gradients, for any matrix", false, 10, makeBiconjugateGradients},
    {"gmres", "generalised minimal residuals, for any matrix; begins anew after --restart steps", false, 7,
     makeGeneralizedMinimalResiduals, true},
};

}  // namespace

std::span<const MethodKind> methodKinds() { return methods; }

}  // namespace sk::linear
