// SPDX-License-Identifier: MIT
//
// Products with, and solvers of, the matrices of grids, as sk::linear has them. They choose their own targets: natively they are raced, and
// once on a GPU, as "compute".
//
// * diagonals: a 5-point matrix with numbers of its own in each row, times a vector. ints and floats as in sparse.cpp.
// * gradients: iterations of conjugate gradients for Poisson's equation on a grid. floats: the right-hand side.
// * nested: cycles of full multigrid for Poisson's equation on a cube of elements, which must reach the error of the discretisation. floats:
//   the right-hand side, the square of the spacing included, for the solution sin(pi x) sin(pi y) sin(pi z) on the unit cube.
// * cycled: conjugate gradients with multigrid on 150^3 elements, to a residual of 1e-8 in double precision. The solution is ones.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include "constants.hpp"
#include "layout.hpp"
#include "method.hpp"
#include "multigrid.hpp"
#include "operator.hpp"
#include "operator_matrix.hpp"
#include "our_task.hpp"
#include "preconditioner.hpp"
#include "programs/all.hpp"
#include "solve.hpp"
#include "stencil.hpp"
#include "support/named.hpp"

namespace race {
namespace {

/// After the first cycle, the error is 30 times that of the discretisation; after the second, it is that.
constexpr std::int64_t nestedCycles = 2;
constexpr std::int64_t cycledExtent = 150;
/// Plain sums, as the peers' are.
const sk::linear::Arithmetic plainSums{.accumulate = sk::Accumulate::Tree};

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Throws where a contender would be the same as another one, or take minutes.
void checkTarget(const sk::Device& device, const sk::CallOptions& options) {
  if (device.profile() == "native") return;
  if (device.isSoftware()) throw std::runtime_error("solvers take too long on renderers in software");
  if (options.target != sk::Target::Compute)
    throw std::runtime_error("solvers choose their targets, and are raced once");
}

class Diagonals final : public OurTask {
 public:
  Diagonals(sk::Device& device, const Problem& p)
      : OurTask(device),
        matrix_(sk::linear::makeMatrix(device, matrixOf(p), "diagonals", plainSums)),
        x_(filled<float>({p.size()}, p.floats[1])),
        y_(device.stream<float>({p.size()})) {}

  std::vector<float> result() override { return y_.read(); }

 private:
  void once() override { matrix_->multiply(x_, y_); }

  static sk::linear::SparseMatrix matrixOf(const Problem& p) {
    sk::linear::SparseMatrix a;
    a.rows = a.columns = p.size();
    a.starts.assign(p.ints[0].begin(), p.ints[0].end());
    a.column = p.ints[1];
    a.value.assign(p.floats[0].begin(), p.floats[0].end());
    return a;
  }

  std::unique_ptr<sk::linear::Matrix> matrix_;
  sk::linear::Vector x_, y_;
};

class Gradients final : public OurTask {
 public:
  Gradients(sk::Device& device, const Problem& p)
      : OurTask(device),
        steps_(gradientSteps(static_cast<double>(p.size()))),
        matrix_(sk::linear::makeMatrix(sk::linear::poisson({p.rows, p.columns}), plainSums)),
        method_(examples::rowNamed(sk::linear::methodKinds(), "cg", "solver")
                    .make(device, *matrix_, nullptr, plainSums)),
        b_(filled<float>(matrix_->domain(), p.floats[0])) {}

  std::vector<float> result() override {
    const std::vector<double> x = method_->solution();
    return {x.begin(), x.end()};
  }

 private:
  void once() override {
    method_->begin(b_, 0.0);
    const std::int64_t ran = method_->run(steps_, steps_);
    if (ran != steps_) throw std::runtime_error(fmt::format("ended after {} iterations", ran));
  }

  std::int64_t steps_;
  std::unique_ptr<sk::linear::Matrix> matrix_;
  std::unique_ptr<sk::linear::Method> method_;
  sk::linear::Vector b_;
};

/// The elements along each side of the cube.
std::int64_t sideOf(const Problem& p) { return p.rows; }

/// sin(pi x) sin(pi y) sin(pi z) on a cube of elements.
class Bump {
 public:
  explicit Bump(std::int64_t side) {
    for (std::int64_t k = 1; k <= side; ++k)
      sines_.push_back(std::sin(std::numbers::pi * static_cast<double>(k) / static_cast<double>(side + 1)));
  }

  double operator()(std::int64_t i) const {
    const auto side = static_cast<std::int64_t>(sines_.size());
    return sines_[at(i % side)] * sines_[at(i / side % side)] * sines_[at(i / side / side)];
  }

 private:
  std::vector<double> sines_;
};

/// Corrections by full multigrid, each of what the ones before have left.
class Nested final : public OurTask {
 public:
  Nested(sk::Device& device, const Problem& p)
      : OurTask(device),
        stencil_(sk::linear::poisson({sideOf(p), sideOf(p), sideOf(p)})),
        matrix_(sk::linear::makeMatrix(stencil_, plainSums)),
        multigrid_(sk::linear::makeMultigrid(device, stencil_, plainSums,
                                             {.cycle = sk::linear::Cycle::Full, .isSymmetric = false})),
        method_(examples::rowNamed(sk::linear::methodKinds(), "stationary", "solver")
                    .make(device, *matrix_, multigrid_.get(), plainSums)),
        b_(filled<float>(matrix_->domain(), p.floats[0])) {}

  std::vector<float> result() override {
    const std::vector<double> x = method_->solution();
    return {x.begin(), x.end()};
  }

 private:
  void once() override {
    method_->begin(b_, 0.0);
    method_->run(nestedCycles, nestedCycles);
  }

  sk::linear::Stencil stencil_;
  std::unique_ptr<sk::linear::Matrix> matrix_;
  std::unique_ptr<sk::linear::Preconditioner> multigrid_;
  std::unique_ptr<sk::linear::Method> method_;
  sk::linear::Vector b_;
};

class Cycled final : public OurTask {
 public:
  explicit Cycled(sk::Device& device)
      : OurTask(device),
        a_(sk::linear::operatorOf(sk::linear::poisson({cycledExtent, cycledExtent, cycledExtent}))),
        b_(a_.multiply(std::vector<double>(at(a_.size), 1.0))),
        matrix_(sk::linear::makeMatrix(sk::linear::Space(device, sk::linear::shapeOf(a_)), a_, "stencil",
                                       plainSums)),
        preconditioner_(examples::rowNamed(sk::linear::preconditionerKinds(), "multigrid", "preconditioner")
                            .make(device, *matrix_, a_, plainSums)),
        method_(examples::rowNamed(sk::linear::methodKinds(), "cg", "solver")
                    .make(device, *matrix_, preconditioner_.get(), plainSums)) {}

  std::vector<float> result() override { return {solution_.x.begin(), solution_.x.end()}; }

 private:
  void once() override {
    solution_ = sk::linear::solve(*method_, a_, b_, plainSums, {.tolerance = 1e-8, .every = 1});
    if (solution_.outcome != sk::linear::Outcome::Converged)
      throw std::runtime_error(fmt::format("{}, with a residual of {:.2g}",
                                           sk::linear::nameOf(solution_.outcome), solution_.residualTrue));
  }

  sk::linear::Operator a_;
  std::vector<double> b_;
  std::unique_ptr<sk::linear::Matrix> matrix_;
  std::unique_ptr<sk::linear::Preconditioner> preconditioner_;
  std::unique_ptr<sk::linear::Method> method_;
  sk::linear::Solution solution_;
};

}  // namespace

Problem diagonalsProblem(int log2) {
  Problem p = grid(log2);
  const std::int64_t n = p.size();
  const std::vector<float> values = numbers(5 * n, 1);
  p.floats = {{}, numbers(n, 2)};
  p.ints = {{0}, {}};
  p.floats[0].reserve(at(5 * n));
  p.ints[0].reserve(at(n + 1));
  p.ints[1].reserve(at(5 * n));
  const std::int64_t offsets[] = {-p.columns, -1, 0, 1, p.columns};
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t x = i % p.columns, y = i / p.columns;
    const bool isInside[] = {y > 0, x > 0, true, x + 1 < p.columns, y + 1 < p.rows};
    for (std::size_t k = 0; k < 5; ++k) {
      if (!isInside[k]) continue;
      p.ints[1].push_back(static_cast<std::int32_t>(i + offsets[k]));
      p.floats[0].push_back(values[5 * at(i) + k]);
    }
    p.ints[0].push_back(static_cast<std::int32_t>(p.ints[1].size()));
  }
  return p;
}

std::unique_ptr<Task> diagonalsOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  checkTarget(device, options);
  return std::make_unique<Diagonals>(device, p);
}

Problem gradientsProblem(int log2) {
  Problem p = grid(log2);
  p.floats = {numbers(p.size(), 6)};
  return p;
}

/// As many iterations in double precision. A hundredth, since Eigen's sums of 2^24 floats are 0.5 % off; ours and those of OpenMP keep to a thousandth.
Check gradientsCheck(const Problem& p) {
  const sk::linear::Stencil a = sk::linear::poisson({p.rows, p.columns});
  const std::size_t n = at(p.size());
  std::vector<double> x(n), r(p.floats[0].begin(), p.floats[0].end()), direction = r;
  const auto dot = [n](const std::vector<double>& u, const std::vector<double>& v) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += u[i] * v[i];
    return sum;
  };
  double rr = dot(r, r);
  for (int step = 0; step < gradientSteps(static_cast<double>(n)); ++step) {
    const std::vector<double> q = sk::linear::multiply(a, direction);
    const double alpha = rr / dot(direction, q);
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += alpha * direction[i];
      r[i] -= alpha * q[i];
    }
    const double next = dot(r, r), beta = next / rr;
    for (std::size_t i = 0; i < n; ++i) direction[i] = r[i] + beta * direction[i];
    rr = next;
  }
  Check check{somePlaces(p.size()), {}, 1e-2};
  for (const std::int64_t i : check.places) check.values.push_back(x[at(i)]);
  return check;
}

std::unique_ptr<Task> gradientsOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  checkTarget(device, options);
  return std::make_unique<Gradients>(device, p);
}

Problem nestedProblem(int log2) {
  Problem p;
  p.rows = std::int64_t{1} << (log2 / 3);
  p.columns = p.rows * p.rows;
  const double factor = 3 * std::pow(std::numbers::pi / static_cast<double>(p.rows + 1), 2);
  const Bump bump(p.rows);
  p.floats.resize(1);
  p.floats[0].reserve(at(p.size()));
  for (std::int64_t i = 0; i < p.size(); ++i) p.floats[0].push_back(static_cast<float>(factor * bump(i)));
  return p;
}

/// The equations of the grid have a solution that is too large by (pi h)^2 / 12. Twice that is allowed.
Check nestedCheck(const Problem& p) {
  const Bump bump(sideOf(p));
  Check check{
      somePlaces(p.size()), {}, 2 * std::pow(std::numbers::pi / static_cast<double>(sideOf(p) + 1), 2) / 12};
  for (const std::int64_t i : check.places) check.values.push_back(bump(i));
  return check;
}

std::unique_ptr<Task> nestedOurs(sk::Device& device, const sk::CallOptions& options, const Problem& p) {
  checkTarget(device, options);
  return std::make_unique<Nested>(device, p);
}

Problem cycledProblem(int) {
  Problem p;
  p.rows = cycledExtent;
  p.columns = cycledExtent * cycledExtent;
  return p;
}

/// The error is the residual's part of x, times the condition number of some 10,000, at worst.
Check cycledCheck(const Problem& p) {
  return {somePlaces(p.size()), std::vector<double>(somePlaces(p.size()).size(), 1.0), 1e-4};
}

std::unique_ptr<Task> cycledOurs(sk::Device& device, const sk::CallOptions& options, const Problem&) {
  checkTarget(device, options);
  return std::make_unique<Cycled>(device);
}

}  // namespace race
