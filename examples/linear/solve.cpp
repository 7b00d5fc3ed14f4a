// SPDX-License-Identifier: MIT
#include "solve.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "support/stopwatch.hpp"

namespace linear {

namespace {

/// Scaled by the largest element, so that squares neither overflow nor vanish.
double norm(std::span<const double> v) {
  double largest = 0.0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  if (largest == 0.0 || !std::isfinite(largest)) return largest;
  double sum = 0.0;
  for (const double x : v) sum += (x / largest) * (x / largest);
  return largest * std::sqrt(sum);
}

double infinityNorm(std::span<const double> v) {
  double largest = 0.0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  return largest;
}

/// But for what rounding the elements and adding them may give.
bool addsUpToZero(std::span<const double> b) {
  double sum = 0.0, magnitudes = 0.0;
  for (const double v : b) {
    sum += v;
    magnitudes += std::abs(v);
  }
  return std::abs(sum) <= 0x1p-40 * magnitudes;
}

std::vector<double> residual(const Operator& a, std::span<const double> b, std::span<const double> x) {
  std::vector<double> r = a.multiply(x);
  for (std::size_t i = 0; i < r.size(); ++i) r[i] = b[i] - r[i];
  return r;
}

/// One solve after the other for what is left of b.
class Refinement {
 public:
  Refinement(Method& method, const Operator& a, std::span<const double> b, const Arithmetic& arithmetic,
             const SolveSettings& settings)
      : method_(method), a_(a), b_(b), arithmetic_(arithmetic), settings_(settings), normB_(norm(b)) {}

  Solution run() {
    const examples::Stopwatch watch;
    solution_.x.assign(b_.size(), 0.0);
    residual_.assign(b_.begin(), b_.end());
    solution_.outcome = outcome();
    const double normR = norm(residual_);
    solution_.residualTrue = normB_ > 0.0 ? normR / normB_ : 0.0;
    const double scale = a_.infinityNorm * infinityNorm(solution_.x) + infinityNorm(b_);
    solution_.backwardError = scale > 0.0 ? infinityNorm(residual_) / scale : 0.0;
    solution_.seconds = watch.milliseconds() / 1000.0;
    return std::move(solution_);
  }

 private:
  Outcome outcome() {
    if (a_.hasConstantKernel && a_.asymmetry.empty() && !addsUpToZero(b_))
      return Outcome::SingularAndIncompatible;
    const double goal = settings_.tolerance * normB_;
    double left = normB_;
    while (left > goal) {
      const State state = solveOnce(goal / left);
      const double reached = addIfBetter(left);
      const bool isBetter = reached < left;
      const bool isMuchBetter = reached < 0.5 * left;
      left = std::min(left, reached);
      if (left <= goal) break;
      if (state == NotFinite && !isMuchBetter) return Outcome::NotFinite;
      if (state == NotPositive && !isMuchBetter) return Outcome::NotPositiveDefinite;
      if (state == Breakdown && !isBetter) return Outcome::Breakdown;
      if (solution_.iterations >= settings_.most) return Outcome::MostIterations;
      if (!isMuchBetter || !settings_.refines) return Outcome::Stagnated;
      ++solution_.restarts;
    }
    return a_.hasConstantKernel ? Outcome::SingularAndCompatible : Outcome::Converged;
  }

  /// Solves for residual_, to `goal` of its norm or to what the precision can give, and leaves the iterations' state.
  State solveOnce(double goal) {
    const double normR = norm(residual_);
    // A power of two, so that only the storage rounds.
    factor_ = std::ldexp(1.0, -std::ilogb(infinityNorm(residual_)));
    std::vector<double> r(residual_.size());
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = factor_ * residual_[i];
    const double reachable = settings_.refines ? std::max(goal / 2.0, 64.0 * arithmetic_.roundoff()) : goal;
    const double squared = norm(r) * norm(r);
    method_.begin(r, reachable * reachable * squared);
    State state = Running;
    const double start = std::sqrt(squared);
    double least = solution_.residualRecurred = normR / normB_;
    std::int64_t leastAt = solution_.iterations;
    const std::int64_t firstAt = solution_.iterations;
    while (state == Running && solution_.iterations < settings_.most) {
      const std::int64_t ran =
          method_.run(settings_.every, std::min(settings_.every, settings_.most - solution_.iterations));
      state = method_.state();
      solution_.iterations += ran;
      solution_.residualRecurred = std::sqrt(std::abs(method_.residualSquared())) / start * normR / normB_;
      solution_.history.push_back({solution_.iterations, solution_.residualRecurred});
      if (settings_.progress) settings_.progress(solution_.iterations, solution_.residualRecurred);
      if (solution_.residualRecurred < 0.99 * least) {
        least = solution_.residualRecurred;
        leastAt = solution_.iterations;
      }
      // Plateaus grow with the number of iterations that a system needs.
      if (ran == 0 ||
          solution_.iterations - leastAt > std::max(method_.patience(), (solution_.iterations - firstAt) / 2))
        break;
    }
    return state;
  }

  /// Adds the method's solution where that makes the residual smaller. Returns the residual's norm with it.
  double addIfBetter(double left) {
    std::vector<double> x = method_.solution();
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = solution_.x[i] + x[i] * (a_.scale / factor_);
    std::vector<double> r = residual(a_, b_, x);
    const double reached = norm(r);
    if (!(reached < left)) return std::isfinite(reached) ? reached : left;
    solution_.x = std::move(x);
    residual_ = std::move(r);
    return reached;
  }

  Method& method_;
  const Operator& a_;
  std::span<const double> b_;
  const Arithmetic& arithmetic_;
  const SolveSettings& settings_;
  double normB_;
  double factor_ = 1.0;
  std::vector<double> residual_;
  Solution solution_;
};

}  // namespace

std::string_view nameOf(Outcome outcome) {
  switch (outcome) {
    case Outcome::Converged: return "converged";
    case Outcome::SingularAndCompatible: return "singular and compatible";
    case Outcome::SingularAndIncompatible: return "singular and incompatible";
    case Outcome::MostIterations: return "most iterations";
    case Outcome::Stagnated: return "stagnated";
    case Outcome::NotPositiveDefinite: return "not positive definite";
    case Outcome::Breakdown: return "breakdown";
    case Outcome::NotFinite: return "not finite";
  }
  return "";
}

Solution solve(Method& method, const Operator& a, std::span<const double> b, const Arithmetic& arithmetic,
               const SolveSettings& settings) {
  if (static_cast<std::int64_t>(b.size()) != a.size)
    throw std::runtime_error(
        fmt::format("the right-hand side has {} elements, and the matrix {} rows", b.size(), a.size));
  if (!std::ranges::all_of(b, [](double v) { return std::isfinite(v); }))
    throw std::runtime_error("the right-hand side has elements that are not finite");
  return Refinement(method, a, b, arithmetic, settings).run();
}

}  // namespace linear
