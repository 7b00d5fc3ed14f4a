// SPDX-License-Identifier: MIT
//
// A 5-point matrix as five diagonals, and conjugate gradients for Poisson's equation on a grid without a matrix.
#include <array>
#include <vector>

#include "constants.hpp"
#include "peers/openmp/all.hpp"

namespace race {
namespace {

class Diagonals final : public Task {
 public:
  explicit Diagonals(const Problem& p) : x_(p.floats[1]), rows_(p.rows), columns_(p.columns), y_(x_.size()) {
    for (auto& diagonal : diagonals_) diagonal.assign(x_.size(), 0.0f);
    for (std::int64_t i = 0; i < p.size(); ++i) {
      const auto row = static_cast<std::size_t>(i);
      for (std::int32_t k = p.ints[0][row]; k < p.ints[0][row + 1]; ++k) {
        const std::int64_t offset = p.ints[1][static_cast<std::size_t>(k)] - i;
        const std::size_t d = offset == -columns_  ? 0
                              : offset == columns_ ? 4
                                                   : static_cast<std::size_t>(offset + 2);
        diagonals_[d][row] = p.floats[0][static_cast<std::size_t>(k)];
      }
    }
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) once();
  }
  std::vector<float> result() override { return y_; }

 private:
  void once() {
#pragma omp parallel for
    for (std::int64_t row = 0; row < rows_; ++row) {
      const std::int64_t begin = row * columns_, end = begin + columns_;
      if (row == 0 || row + 1 == rows_) {
        for (std::int64_t i = begin; i < end; ++i) y_[static_cast<std::size_t>(i)] = atBorder(i);
        continue;
      }
      const float* x = x_.data();
      float* y = y_.data();
      const float *a = diagonals_[0].data(), *b = diagonals_[1].data(), *c = diagonals_[2].data(),
                  *d = diagonals_[3].data(), *e = diagonals_[4].data();
#pragma omp simd
      for (std::int64_t i = begin; i < end; ++i)
        y[i] =
            a[i] * x[i - columns_] + b[i] * x[i - 1] + c[i] * x[i] + d[i] * x[i + 1] + e[i] * x[i + columns_];
    }
  }

  float atBorder(std::int64_t i) const {
    const std::array<std::int64_t, 5> offsets = {-columns_, -1, 0, 1, columns_};
    float sum = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      const std::int64_t j = i + offsets[k];
      if (j < 0 || j >= static_cast<std::int64_t>(x_.size())) continue;
      sum += diagonals_[k][static_cast<std::size_t>(i)] * x_[static_cast<std::size_t>(j)];
    }
    return sum;
  }

  const std::vector<float>& x_;
  std::int64_t rows_, columns_;
  std::array<std::vector<float>, 5> diagonals_;
  std::vector<float> y_;
};

/// q = A p, and p . q. Two rows of zeros and two columns of them surround p.
double product(const float* p, float* q, std::int64_t rows, std::int64_t columns) {
  const std::int64_t pitch = columns + 2;
  double sum = 0;
#pragma omp parallel for reduction(+ : sum)
  for (std::int64_t row = 0; row < rows; ++row) {
    const float* own = p + (row + 1) * pitch + 1;
    float* result = q + row * columns;
    float ofRow = 0;
#pragma omp simd reduction(+ : ofRow)
    for (std::int64_t i = 0; i < columns; ++i) {
      const float value = 4 * own[i] - own[i - 1] - own[i + 1] - own[i - pitch] - own[i + pitch];
      result[i] = value;
      ofRow += own[i] * value;
    }
    sum += ofRow;
  }
  return sum;
}

class Gradients final : public Task {
 public:
  explicit Gradients(const Problem& problem)
      : b_(problem.floats[0]),
        rows_(problem.rows),
        columns_(problem.columns),
        x_(b_.size()),
        p_(static_cast<std::size_t>((rows_ + 2) * pitch())),
        q_(b_.size()),
        r_(b_.size()) {}

  void run(int times) override {
    for (int i = 0; i < times; ++i) once();
  }
  std::vector<float> result() override { return x_; }

 private:
  std::int64_t pitch() const { return columns_ + 2; }
  float* directionOf(std::int64_t row) { return p_.data() + (row + 1) * pitch() + 1; }

  void once() {
    double rr = start();
    for (int step = 0; step < gradientSteps(static_cast<double>(b_.size())); ++step) {
      const auto alpha = static_cast<float>(rr / product(p_.data(), q_.data(), rows_, columns_));
      const double next = advance(alpha);
      turn(static_cast<float>(next / rr));
      rr = next;
    }
  }

  double start() {
    double rr = 0;
#pragma omp parallel for reduction(+ : rr)
    for (std::int64_t row = 0; row < rows_; ++row) {
      const float* b = b_.data() + row * columns_;
      float *x = x_.data() + row * columns_, *r = r_.data() + row * columns_, *p = directionOf(row);
      float sum = 0;
#pragma omp simd reduction(+ : sum)
      for (std::int64_t i = 0; i < columns_; ++i) {
        x[i] = 0;
        r[i] = p[i] = b[i];
        sum += b[i] * b[i];
      }
      rr += sum;
    }
    return rr;
  }

  double advance(float alpha) {
    double rr = 0;
#pragma omp parallel for reduction(+ : rr)
    for (std::int64_t row = 0; row < rows_; ++row) {
      const float *p = directionOf(row), *q = q_.data() + row * columns_;
      float *x = x_.data() + row * columns_, *r = r_.data() + row * columns_;
      float sum = 0;
#pragma omp simd reduction(+ : sum)
      for (std::int64_t i = 0; i < columns_; ++i) {
        x[i] += alpha * p[i];
        const float rest = r[i] - alpha * q[i];
        r[i] = rest;
        sum += rest * rest;
      }
      rr += sum;
    }
    return rr;
  }

  void turn(float beta) {
#pragma omp parallel for
    for (std::int64_t row = 0; row < rows_; ++row) {
      float* p = directionOf(row);
      const float* r = r_.data() + row * columns_;
      for (std::int64_t i = 0; i < columns_; ++i) p[i] = r[i] + beta * p[i];
    }
  }

  const std::vector<float>& b_;
  std::int64_t rows_, columns_;
  std::vector<float> x_, p_, q_, r_;
};

}  // namespace

std::unique_ptr<Task> diagonalsOpenMp(const Problem& p) { return std::make_unique<Diagonals>(p); }
std::unique_ptr<Task> gradientsOpenMp(const Problem& p) { return std::make_unique<Gradients>(p); }

}  // namespace race
