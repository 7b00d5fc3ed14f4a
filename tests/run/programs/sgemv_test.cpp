// SPDX-License-Identifier: MIT
//
// sgemv.sk against a plain loop in double. Each term has at most n + 3 roundings: of the product, of a sum of n products in any
// order, of the factors alpha and beta, and of the last sum.
#include "programs/sgemv.sk.hpp"

#include "programs/bounds.hpp"
#include "support/devices.hpp"

using namespace run_tests;

namespace {

struct Problem {
  std::int64_t rows, columns;
  float alpha = 0.7f, beta = -1.3f;
  std::vector<float> a = noises(rows * columns, 1), x = noises(columns, 2), y = noises(rows, 3);

  Bounded expected(std::size_t row) const {
    const auto n = static_cast<std::size_t>(columns);
    double dot = 0, size = 0;
    for (std::size_t k = 0; k < n; ++k) {
      dot += double{a[row * n + k]} * x[k];
      size += std::fabs(double{a[row * n + k]} * x[k]);
    }
    return {alpha * dot + beta * double{y[row]},
            roundings(static_cast<double>(n) + 3) * (std::fabs(alpha) * size + std::fabs(beta * y[row]))};
  }
};

const std::vector<std::pair<std::int64_t, std::int64_t>> shapes = {{1, 1},   {7, 1},   {1, 7},    {13, 17},
                                                                   {64, 64}, {67, 61}, {3, 1021}, {1009, 2}};
/// Longer than a row of a texture, and more elements than a small device holds.
const std::vector<std::pair<std::int64_t, std::int64_t>> largeShapes = {{3, 20011}, {307, 211}};

/// Checks the variant with a product for each element and a sum over each row.
void checkSteps(sk::Device& device, std::int64_t rows, std::int64_t columns) {
  INFO(rows << " x " << columns);
  const Problem problem{rows, columns};
  const auto a = streamOf<float>(device, {rows, columns}, problem.a);
  const auto x = streamOf<float>(device, {1, columns}, problem.x);
  auto y = streamOf<float>(device, {rows, 1}, problem.y);
  auto product = device.stream<float>({rows, columns}), sums = device.stream<float>({rows, 1});
  sgemv::weigh(a, x, product);
  sgemv::sum(product, sums);
  sgemv::update(problem.alpha, sums, problem.beta, y, y);
  CHECK(outside(y.read(), [&](std::size_t i) { return problem.expected(i); }) == "");
}

void checkOnePass(sk::Device& device, std::int64_t rows, std::int64_t columns) {
  INFO(rows << " x " << columns);
  const Problem problem{rows, columns};
  auto y = streamOf<float>(device, problem.y);
  sgemv::gemv(problem.alpha, streamOf<float>(device, {rows, columns}, problem.a),
              streamOf<float>(device, problem.x), problem.beta, y, y);
  CHECK(outside(y.read(), [&](std::size_t i) { return problem.expected(i); }) == "");
}

}  // namespace

TEST_CASE("sgemv: a product for each element, and a sum over each row") {
  onDrawnLayouts([](sk::Device& device) {
    for (const auto& [rows, columns] : shapes) checkSteps(device, rows, columns);
    for (const auto& [rows, columns] : {std::pair{0, 0}, {0, 5}, {5, 0}}) checkSteps(device, rows, columns);
  });
  onGlAndNative([](sk::Device& device) {
    for (const auto& [rows, columns] : largeShapes) checkSteps(device, rows, columns);
  });
}

TEST_CASE("sgemv: in one pass") {
  onDrawnLayouts([](sk::Device& device) {
    for (const auto& [rows, columns] : shapes) checkOnePass(device, rows, columns);
  });
  onGlAndNative([](sk::Device& device) {
    for (const auto& [rows, columns] : largeShapes) checkOnePass(device, rows, columns);
  });
}
