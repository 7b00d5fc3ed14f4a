// SPDX-License-Identifier: MIT
//
// ViennaCL (K. Rupp and others, "ViennaCL: linear algebra library for multi- and many-core architectures", 2016), on the cores of the host: products of
// sparse matrices in compressed rows, and pipelined conjugate gradients. A thread adds its floats one after the other: on one core, its results for 2^20 unknowns are 2 % off
// and miss the check.
#define VIENNACL_WITH_OPENMP

#include <viennacl/compressed_matrix.hpp>
#include <viennacl/linalg/cg.hpp>
#include <viennacl/linalg/prod.hpp>
#include <viennacl/vector.hpp>

#include <cstdint>
#include <memory>
#include <vector>

#include "constants.hpp"
#include "contender.hpp"

namespace race {
namespace {

using Matrix = viennacl::compressed_matrix<float>;
using Vector = viennacl::vector<float>;
using Indices = std::vector<unsigned int>;  // as the matrix holds them in host memory

Vector vectorOf(const std::vector<float>& numbers) {
  Vector v(numbers.size());
  viennacl::copy(numbers, v);
  return v;
}

std::vector<float> numbersOf(const Vector& v) {
  std::vector<float> numbers(v.size());
  viennacl::copy(v, numbers);
  return numbers;
}

void assign(Matrix& a, const Indices& starts, const Indices& columns, const std::vector<float>& values) {
  a.set(starts.data(), columns.data(), values.data(), starts.size() - 1, starts.size() - 1, values.size());
}

class Product final : public Task {
 public:
  explicit Product(const Problem& p) : x_(vectorOf(p.floats[1])), y_(static_cast<std::size_t>(p.size())) {
    assign(a_, {p.ints[0].begin(), p.ints[0].end()}, {p.ints[1].begin(), p.ints[1].end()}, p.floats[0]);
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i) y_ = viennacl::linalg::prod(a_, x_);
  }
  std::vector<float> result() override { return numbersOf(y_); }

 private:
  Matrix a_;
  Vector x_, y_;
};

class Gradients final : public Task {
 public:
  explicit Gradients(const Problem& p)
      : steps_(static_cast<unsigned int>(gradientSteps(static_cast<double>(p.size())))),
        b_(vectorOf(p.floats[0])),
        x_(static_cast<std::size_t>(p.size())) {
    assignPoisson(p.rows, p.columns);
  }

  void run(int times) override {
    for (int i = 0; i < times; ++i)
      x_ = viennacl::linalg::solve(a_, b_, viennacl::linalg::cg_tag(0.0, steps_));
  }
  std::vector<float> result() override { return numbersOf(x_); }

 private:
  /// Minus the Laplacian of a grid, times the square of its spacing.
  void assignPoisson(std::int64_t rows, std::int64_t columns) {
    Indices starts{0}, column;
    std::vector<float> value;
    const auto add = [&](std::int64_t j, float v) {
      column.push_back(static_cast<unsigned int>(j));
      value.push_back(v);
    };
    for (std::int64_t y = 0; y < rows; ++y)
      for (std::int64_t x = 0; x < columns; ++x) {
        const std::int64_t i = y * columns + x;
        if (y > 0) add(i - columns, -1);
        if (x > 0) add(i - 1, -1);
        add(i, 4);
        if (x + 1 < columns) add(i + 1, -1);
        if (y + 1 < rows) add(i + columns, -1);
        starts.push_back(static_cast<unsigned int>(column.size()));
      }
    assign(a_, starts, column, value);
  }

  unsigned int steps_;
  Matrix a_;
  Vector b_, x_;
};

}  // namespace
}  // namespace race

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  for (const char* program : {"sparse matrix", "power-law matrix", "5-point matrix"}) {
    contenders.push_back(
        {program, "ViennaCL", [](const Problem& p) { return std::make_unique<Product>(p); }});
  }
  contenders.push_back(
      {"conjugate gradients", "ViennaCL", [](const Problem& p) { return std::make_unique<Gradients>(p); }});
}
