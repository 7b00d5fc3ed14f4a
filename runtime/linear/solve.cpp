// SPDX-License-Identifier: MIT
#include "solve.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "residual.hpp"

namespace sk::linear {

namespace {

double infinityNorm(std::span<const double> v) {
  double largest = 0.0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  return largest;
}

double meanOf(std::span<const double> v) {
  double sum = 0.0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
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

/// One solve after the other for what is left of b.
class Refinement {
 public:
  Refinement(Method& method, Residual& residual, const Operator& a, std::span<const double> b,
             const Arithmetic& arithmetic, const SolveSettings& settings)
      : method_(method), a_(a), b_(b), arithmetic_(arithmetic), settings_(settings), residual_(residual) {}

  Solution run() {
    const auto start = std::chrono::steady_clock::now();
    std::vector<double> scaled(b_.begin(), b_.end());
    const bool isProjected = a_.hasConstantKernel && a_.isGrid();
    if (isProjected) {
      solution_.removedMean = meanOf(b_);
      for (double& v : scaled) v -= solution_.removedMean;
      // What rounding leaves of a constant is no right-hand side.
      if (infinityNorm(scaled) <= 0x1p-44 * infinityNorm(b_)) std::ranges::fill(scaled, 0.0);
    }
    const double largestB = infinityNorm(scaled);
    // A power of two, as a.scale is: only the storage rounds.
    const int exponent = largestB > 0.0 ? std::ilogb(largestB) : 0;
    for (double& v : scaled) v = std::ldexp(v, -exponent);
    norms_ = residual_.start(scaled);
    normB_ = norms_.two;
    solution_.outcome = outcome();
    const double scale =
        a_.scale * a_.infinityNorm * residual_.largestOfSolution() + std::ldexp(largestB, -exponent);
    solution_.backwardError = scale > 0.0 ? norms_.infinity / scale : 0.0;
    solution_.x = residual_.solution();
    if (isProjected && !solution_.x.empty()) removeMean(scaled);
    noteResidual();
    for (double& v : solution_.x) v = std::ldexp(v * a_.scale, exponent);
    solution_.residualPlace = residual_.place();
    solution_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(solution_);
  }

 private:
  /// Subtracts the mean of x, which rounds x once more, and measures the residual again where its error is no longer small.
  void removeMean(std::span<const double> b) {
    const double mean = meanOf(solution_.x);
    for (double& v : solution_.x) v -= mean;
    const double normX = normsOf(solution_.x).two;
    norms_.error += roundingOfResidual(a_, a_.scale * boundOfNorm(a_), normX, 0.0);
    if (!isKnown(norms_)) norms_ = preciseResidual(a_, a_.scale, solution_.x, b).norms;
  }

  void noteResidual() {
    if (!(normB_ > 0.0)) return;
    solution_.residualTrue = norms_.two / normB_;
    // The norm of b is rounded, too.
    solution_.residualError =
        norms_.error / normB_ + (static_cast<double>(a_.size) + 4.0) * 0x1p-53 * solution_.residualTrue;
  }

  Outcome outcome() {
    if (a_.hasConstantKernel && !a_.isGrid() && !addsUpToZero(b_) && findAsymmetry(a_).empty())
      return Outcome::SingularAndIncompatible;
    const double goal = settings_.tolerance * normB_;
    int fruitless = 0;
    while (norms_.two > goal) {
      const double left = norms_.two;
      const State state = solveOnce(goal / left);
      const double reached = addIfBetter();
      const bool isBetter = reached < left;
      const bool isMuchBetter = reached < 0.5 * left;
      if (norms_.two <= goal) break;
      fruitless = isMuchBetter ? 0 : fruitless + 1;
      if (settings_.refines && fruitless > 0 && fruitless < method_.attempts() &&
          solution_.iterations < settings_.most) {
        ++solution_.restarts;
        continue;
      }
      if (state == NotFinite && !isMuchBetter) return Outcome::NotFinite;
      if (state == NotPositive && !isMuchBetter) return Outcome::NotPositiveDefinite;
      if (state == Breakdown && !isBetter) return Outcome::Breakdown;
      if (solution_.iterations >= settings_.most) return Outcome::MostIterations;
      if (!isMuchBetter || !settings_.refines) return Outcome::Stagnated;
      ++solution_.restarts;
    }
    return a_.hasConstantKernel ? Outcome::SingularAndCompatible : Outcome::Converged;
  }

  /// Solves for the residual, to `goal` of its norm or to what the precision can give, and leaves the iterations' state.
  State solveOnce(double goal) {
    factor_ = std::ldexp(1.0, -std::ilogb(norms_.infinity));
    residual_.writeTo(method_.rightHandSide(), factor_);
    const double reachable = settings_.refines ? std::max(goal / 2.0, 64.0 * arithmetic_.roundoff()) : goal;
    const double start = factor_ * norms_.two;
    const double limit = reachable * start;
    method_.begin(limit * limit);
    State state = method_.state();
    double least = solution_.residualRecurred = norms_.two / normB_;
    std::int64_t leastAt = solution_.iterations;
    const std::int64_t firstAt = solution_.iterations;
    double kept = 0.0;  // the residual of what the method keeps, if that is above 0
    while (state == Running && solution_.iterations < settings_.most) {
      const std::int64_t ran = method_.advance(settings_.every, settings_.most - solution_.iterations);
      state = method_.state();
      solution_.iterations += ran;
      solution_.residualRecurred =
          std::sqrt(std::abs(method_.residualSquared())) / start * norms_.two / normB_;
      solution_.history.push_back({solution_.iterations, solution_.residualRecurred});
      if (settings_.progress) settings_.progress(solution_.iterations, solution_.residualRecurred);
      if (solution_.residualRecurred < 0.99 * least) {
        least = solution_.residualRecurred;
        leastAt = solution_.iterations;
        if (method_.attempts() > 1) {
          method_.keep();
          kept = least;
        }
      }
      // Plateaus grow with the number of iterations that a system needs.
      const std::int64_t patience =
          std::max({method_.patience(), settings_.patience, (solution_.iterations - firstAt) / 2});
      if (ran == 0 || solution_.iterations - leastAt > patience) break;
    }
    if (kept > 0.0 && !(solution_.residualRecurred <= kept)) method_.restore();
    return state;
  }

  /// Adds the method's solution where that makes the residual smaller. Returns the residual's norm with it.
  double addIfBetter() {
    const Norms reached = residual_.attempt(method_.x(), 1.0 / factor_);
    if (!(reached.two < norms_.two)) return std::isfinite(reached.two) ? reached.two : norms_.two;
    residual_.accept();
    norms_ = reached;
    return reached.two;
  }

  Method& method_;
  const Operator& a_;
  std::span<const double> b_;
  const Arithmetic& arithmetic_;
  const SolveSettings& settings_;
  Residual& residual_;
  Norms norms_;  ///< of the residual now
  double normB_ = 0.0;
  double factor_ = 1.0;
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

void checkFinite(std::span<const double> b) {
  const auto wrong = std::ranges::find_if(b, [](double v) { return !std::isfinite(v); });
  if (wrong != b.end())
    throw sk::Error(fmt::format("element {} of the right-hand side is {}, which is not finite",
                                wrong - b.begin() + 1, *wrong));
}

Solution solve(Method& method, const Operator& a, std::span<const double> b, const Arithmetic& arithmetic,
               const SolveSettings& settings) {
  const std::unique_ptr<Residual> residual = makeResidual(method.device(), method.matrix(), a, arithmetic);
  return solve(method, *residual, a, b, arithmetic, settings);
}

Solution solve(Method& method, Residual& residual, const Operator& a, std::span<const double> b,
               const Arithmetic& arithmetic, const SolveSettings& settings) {
  if (static_cast<std::int64_t>(b.size()) != a.size)
    throw sk::Error(
        fmt::format("the right-hand side has {} elements, and the matrix {} rows", b.size(), a.size),
        sk::Error::Kind::Shape);
  checkFinite(b);
  return Refinement(method, residual, a, b, arithmetic, settings).run();
}

}  // namespace sk::linear
