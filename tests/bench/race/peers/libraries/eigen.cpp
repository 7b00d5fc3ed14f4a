// SPDX-License-Identifier: MIT
//
// Eigen 3 (G. Guennebaud, B. Jacob and others, https://eigen.tuxfamily.org): products of sparse matrices in compressed rows, and conjugate
// gradients without a preconditioner. Its products of such matrices use all cores.
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

#include <memory>
#include <vector>

#include "constants.hpp"
#include "contender.hpp"

namespace race {
namespace {

using Matrix = Eigen::SparseMatrix<float, Eigen::RowMajor, std::int32_t>;
using Vector = Eigen::VectorXf;
using VectorOfProblem = Eigen::Map<const Vector>;

std::vector<float> numbersOf(const Vector& v) { return {v.data(), v.data() + v.size()}; }

class Product final : public Task {
 public:
  explicit Product(const Problem& p)
      : a_(p.size(), p.size(), static_cast<Eigen::Index>(p.floats[0].size()), p.ints[0].data(),
           p.ints[1].data(), p.floats[0].data()),
        x_(p.floats[1].data(), p.size()),
        y_(Vector::Zero(p.size())) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) y_.noalias() = a_ * x_;
  }
  std::vector<float> result() override { return numbersOf(y_); }

 private:
  Eigen::Map<const Matrix> a_;
  VectorOfProblem x_;
  Vector y_;
};

/// Minus the Laplacian of a grid, times the square of its spacing.
Matrix poisson(std::int64_t rows, std::int64_t columns) {
  Matrix a(rows * columns, rows * columns);
  a.reserve(5 * rows * columns);
  for (std::int64_t y = 0; y < rows; ++y) {
    for (std::int64_t x = 0; x < columns; ++x) {
      const std::int64_t i = y * columns + x;
      a.startVec(i);
      if (y > 0) a.insertBack(i, i - columns) = -1;
      if (x > 0) a.insertBack(i, i - 1) = -1;
      a.insertBack(i, i) = 4;
      if (x + 1 < columns) a.insertBack(i, i + 1) = -1;
      if (y + 1 < rows) a.insertBack(i, i + columns) = -1;
    }
  }
  a.finalize();
  return a;
}

class Gradients final : public Task {
 public:
  explicit Gradients(const Problem& p)
      : a_(poisson(p.rows, p.columns)), b_(p.floats[0].data(), p.size()), x_(Vector::Zero(p.size())) {
    solver_.setMaxIterations(gradientSteps(static_cast<double>(p.size())));
    solver_.setTolerance(0);
    solver_.compute(a_);
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) x_ = solver_.solve(b_);
  }
  std::vector<float> result() override { return numbersOf(x_); }

 private:
  Matrix a_;
  VectorOfProblem b_;
  Vector x_;
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper, Eigen::IdentityPreconditioner> solver_;
};

}  // namespace
}  // namespace race

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  for (const char* program : {"sparse matrix", "power-law matrix", "5-point matrix"}) {
    contenders.push_back({program, "Eigen", [](const Problem& p) { return std::make_unique<Product>(p); }});
  }
  contenders.push_back(
      {"conjugate gradients", "Eigen", [](const Problem& p) { return std::make_unique<Gradients>(p); }});
}
