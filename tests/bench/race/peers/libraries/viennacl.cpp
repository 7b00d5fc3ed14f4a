// SPDX-License-Identifier: MIT
//
// ViennaCL (K. Rupp and others, "ViennaCL: linear algebra library for multi- and many-core architectures", 2016), on the cores of the host: products of
// sparse matrices in compressed rows. Its conjugate gradients do not take part: their sums of floats are serial, and after 128 steps on 2^20 unknowns
// the result is 5 % off on two cores, more than the check allows.
#define VIENNACL_WITH_OPENMP

#include <viennacl/compressed_matrix.hpp>
#include <viennacl/linalg/prod.hpp>
#include <viennacl/vector.hpp>

#include <cstdint>
#include <memory>
#include <vector>

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

}  // namespace
}  // namespace race

RACE_ADD_PEERS(std::vector<race::Contender>& contenders) {
  using namespace race;
  for (const char* program : {"sparse matrix", "power-law matrix", "5-point matrix"}) {
    contenders.push_back(
        {program, "ViennaCL", [](const Problem& p) { return std::make_unique<Product>(p); }});
  }
}
