// SPDX-License-Identifier: MIT
//
// itpack.sk against a loop over the entries, in double. A row of n entries has n products and n - 1 sums: no term is
// rounded more than n times. The zeros that pad rows are exact.
#include "programs/itpack.sk.hpp"

#include "programs/bounds.hpp"
#include "support/devices.hpp"

using namespace run_tests;

namespace {

struct Matrix {
  std::int64_t rows, columns, width;  // width: the largest number of entries in a row
  std::vector<float> values = std::vector<float>(static_cast<std::size_t>(rows * width), 0.0f);
  std::vector<int> places = std::vector<int>(static_cast<std::size_t>(rows * width), 0);
};

/// A matrix with rows of 0 to `width` entries in random columns.
Matrix sparse(std::int64_t rows, std::int64_t columns, std::int64_t width) {
  Matrix m{rows, columns, width};
  for (std::size_t i = 0; i < m.values.size(); ++i) {
    const auto entry = static_cast<std::uint32_t>(i) % static_cast<std::uint32_t>(width);
    const auto row = static_cast<std::uint32_t>(i) / static_cast<std::uint32_t>(width);
    if (entry >= hashed(row + 5u) % static_cast<std::uint32_t>(width + 1)) continue;
    m.values[i] = noise(i, 1);
    m.places[i] =
        static_cast<int>(hashed(static_cast<std::uint32_t>(i)) % static_cast<std::uint32_t>(columns));
  }
  return m;
}

Bounded expected(const Matrix& m, const std::vector<float>& x, std::size_t row) {
  const auto width = static_cast<std::size_t>(m.width);
  double sum = 0, size = 0;
  for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
    const double product = double{m.values[i]} * x[static_cast<std::size_t>(m.places[i])];
    sum += product;
    size += std::fabs(product);
  }
  return {sum, roundings(static_cast<double>(width)) * size};
}

void checkBoth(sk::Device& device, std::int64_t rows, std::int64_t columns, std::int64_t width) {
  INFO(rows << " x " << columns << ", at most " << width << " entries in a row");
  const Matrix m = sparse(rows, columns, width);
  const auto x = noises(columns, 2);
  const auto values = streamOf<float>(device, {rows, width}, m.values);
  const auto places = streamOf<int>(device, {rows, width}, m.places);
  const auto vector = streamOf<float>(device, x);
  const auto wanted = [&](std::size_t i) { return expected(m, x, i); };

  auto products = device.stream<float>({rows, width}), sums = device.stream<float>({rows, 1});
  itpack::weigh(values, places, vector, products);
  itpack::sum(products, sums);
  CHECK(outside(sums.read(), wanted) == "");

  auto y = device.stream<float>({rows});
  itpack::multiply(values, places, vector, y);
  CHECK(outside(y.read(), wanted) == "");
}

}  // namespace

TEST_CASE("itpack: a sparse matrix times a vector, in both ways") {
  onDrawnLayouts([](sk::Device& device) {
    for (const auto& [rows, columns, width] : {std::tuple{1, 1, 1},
                                               {1, 64, 7},
                                               {13, 5, 4},
                                               {61, 61, 9},
                                               {128, 256, 16},
                                               {809, 300, 5},
                                               {4, 4001, 900}}) {
      checkBoth(device, rows, columns, width);
    }
  });
  onGlAndNative(
      [](sk::Device& device) { checkBoth(device, 20011, 997, 5); });  // longer than a row of a texture
}
