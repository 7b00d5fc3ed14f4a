// SPDX-License-Identifier: MIT
//
// Products of every layout, on every kind of device, beside those of double precision.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sk/sk.hpp>

#include "layout.hpp"
#include "stencil.hpp"
#include "test_solves.hpp"

namespace sk::linear {
namespace {

/// Values that floats hold.
std::vector<double> randomFloats(std::int64_t n) {
  std::mt19937 random(7);
  std::vector<double> v(static_cast<std::size_t>(n));
  for (double& x : v)
    x = static_cast<double>(static_cast<float>(std::uniform_real_distribution<double>(-1, 1)(random)));
  return v;
}

/// Rows of very different lengths, the first and some others empty; values that floats hold.
SparseMatrix irregular(std::int64_t rows, std::int64_t columns) {
  std::mt19937 random(3);
  std::vector<Entry> entries;
  for (std::int64_t i = 1; i < rows; ++i) {
    const std::int64_t length = i % 7 == 0 ? 0 : i == 5 ? columns : static_cast<std::int64_t>(random() % 9);
    for (std::int64_t k = 0; k < length; ++k)
      entries.push_back({i, static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(columns)),
                         static_cast<double>(static_cast<int>(random() % 2001) - 1000) / 1024.0});
  }
  return assemble(rows, columns, entries);
}

/// |y - A x| against what rounding every product and sum may give: (length + 1) roundings times the sum of magnitudes.
void checkProduct(const SparseMatrix& a, const std::vector<double>& x, const std::vector<double>& y,
                  double roundoff = 0x1p-24) {
  const std::vector<double> expected = multiply(a, x);
  REQUIRE(y.size() == expected.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    double magnitudes = 0.0;
    for (auto k = static_cast<std::size_t>(a.starts[i]); k < static_cast<std::size_t>(a.starts[i + 1]); ++k)
      magnitudes += std::abs(a.value[k] * x[static_cast<std::size_t>(a.column[k])]);
    const double bound =
        static_cast<double>(a.length(static_cast<std::int64_t>(i)) + 1) * roundoff * magnitudes;
    if (std::abs(y[i] - expected[i]) > bound) {
      CAPTURE(i, y[i], expected[i], bound);
      FAIL("a product is off");
    }
  }
}

/// x . A x of a matrix of at most 67 entries in a row.
void checkFold(const SparseMatrix& a, const std::vector<double>& x, double xy, double roundoff = 0x1p-24) {
  const std::vector<double> y = multiply(a, x);
  double expected = 0.0, magnitudes = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    expected += x[i] * y[i];
    magnitudes += std::abs(x[i] * y[i]);
  }
  CHECK(std::abs(xy - expected) <= 72.0 * roundoff * std::max(1.0, magnitudes));
}

std::vector<double> productOf(sk::Device& device, Matrix& matrix, const std::vector<double>& x) {
  Vector in = device.stream<float>(matrix.domain()), out = device.stream<float>(matrix.range());
  in.writeReals(x);
  out.fill(99.0f);
  matrix.multiply(in, out);
  return out.readReals();
}

TEST_CASE("Every layout multiplies alike on every device") {
  const SparseMatrix square = irregular(67, 67), wide = irregular(41, 83);
  const SparseMatrix grid = assemble(poisson({7, 11}));
  for (sk::Device& device : testDevices()) {
    CAPTURE(device.profile());
    for (const LayoutKind& kind : layoutKinds()) {
      CAPTURE(kind.name);
      for (const SparseMatrix* a : {&square, &wide, &grid}) {
        if (kind.name == "diagonals" && a->rows != a->columns) {
          CHECK_THROWS_WITH(kind.make(device, *a, {}), Catch::Contains("takes square matrices"));
          continue;
        }
        const std::unique_ptr<Matrix> matrix = kind.make(device, *a, {});
        const std::vector<double> x = randomFloats(a->columns);
        checkProduct(*a, x, productOf(device, *matrix, x));
      }
    }
  }
}

TEST_CASE("Layouts hold matrices without rows, without entries, and of one element") {
  sk::Device device = sk::Device::native();
  for (const LayoutKind& kind : layoutKinds()) {
    CAPTURE(kind.name);
    for (const std::int64_t n : {0, 1, 5}) {
      const SparseMatrix empty = assemble(n, n, {});
      const std::unique_ptr<Matrix> matrix = kind.make(device, empty, {});
      CHECK(productOf(device, *matrix, randomFloats(n)) ==
            std::vector<double>(static_cast<std::size_t>(n), 0.0));
    }
    const Entry one{0, 0, -2.5};
    const std::unique_ptr<Matrix> matrix = kind.make(device, assemble(1, 1, std::span(&one, 1)), {});
    CHECK(productOf(device, *matrix, {2.0}) == std::vector<double>{-5.0});
  }
}

TEST_CASE("A folded product is x . A x") {
  const SparseMatrix a = irregular(67, 67);
  const std::vector<double> x = randomFloats(67);
  for (sk::Device& device : testDevices()) {
    CAPTURE(device.profile());
    for (const LayoutKind& kind : layoutKinds()) {
      CAPTURE(kind.name);
      const std::unique_ptr<Matrix> matrix = kind.make(device, a, {});
      Vector in = device.stream<float>({67}), out = device.stream<float>({67}),
             xy = device.stream<float>({1});
      in.writeReals(x);
      matrix->multiply(in, out, xy);
      checkFold(a, x, xy.readReals()[0]);
    }
  }
}

TEST_CASE("Layouts take other values of the same entries") {
  sk::Device device = sk::Device::native();
  SparseMatrix a = irregular(67, 67);
  const std::vector<double> x = randomFloats(67);
  for (const LayoutKind& kind : layoutKinds()) {
    CAPTURE(kind.name);
    const std::unique_ptr<Matrix> matrix = kind.make(device, a, {});
    for (double& v : a.value) v = 0.5 - v;
    matrix->update(a);
    CHECK(productOf(device, *matrix, x) == productOf(device, *kind.make(device, a, {}), x));
  }
  CHECK_THROWS_WITH(makeMatrix(poisson({4, 4}), {})->update(a),
                    "a matrix in the layout 'stencil' cannot take other values");
}

TEST_CASE("Stencils are their matrices") {
  for (sk::Device& device : testDevices()) {
    CAPTURE(device.profile());
    for (const sk::Shape& grid : {sk::Shape{1, 1}, sk::Shape{13, 7}, sk::Shape{3, 5, 7}}) {
      Stencil stencil = poisson(grid);
      stencil.along[0] = -0.25;  // dimensions must not be mixed up
      const SparseMatrix a = assemble(stencil);
      const std::vector<double> x = randomFloats(a.columns);
      CHECK(multiply(stencil, x) == multiply(a, x));
      checkProduct(a, x, productOf(device, *makeMatrix(stencil, {}), x));
    }
  }
}

TEST_CASE("Offsets of 16 bits are taken where they fit, and products have the bits of those of 32") {
  // Rows of two entries and of three; the second matrix has one row of two, and the third one of each, whose columns are far apart.
  constexpr std::int64_t n = 40000;
  const auto matrix = [](bool farTwo, bool farThree) {
    std::vector<Entry> entries;
    for (std::int64_t i = 0; i < n; ++i) {
      entries.push_back({i, i, 1.0 + static_cast<double>(i % 5)});
      const bool isFar = (i == 1 && farTwo) || (i == 3 && farThree);
      entries.push_back({i, isFar ? n - 1 : (i + 32767) % n < i ? i - 1 : i + 32767, -0.3});
      if (i % 3 == 0) entries.push_back({i, i == 0 ? 7 : i - 1, 0.7});
    }
    return assemble(n, n, entries);
  };
  const SparseMatrix near = matrix(false, false), mixed = matrix(true, false), far = matrix(true, true);
  const std::vector<double> x = randomFloats(n);
  for (sk::Device& device : testDevices()) {
    CAPTURE(device.profile());
    const auto of = [&](const SparseMatrix& a, std::string_view offsetBits) {
      const auto buckets = makeBuckets(device, a, {});
      CHECK(buckets->offsetBits() == offsetBits);
      std::vector<double> y = productOf(device, *buckets, x);
      checkProduct(a, x, y);
      return y;
    };
    const std::vector<double> narrow = of(near, "16");
    for (std::vector<double> y : {of(mixed, "16 and 32"), of(far, "32")}) {
      y[1] = narrow[1];
      y[3] = narrow[3];
      CHECK(y == narrow);
    }
    CHECK(makeSlices(device, near, {})->offsetBits() == "16");
    CHECK(makeSlices(device, mixed, {})->offsetBits() == "32");
    CHECK(makeRows(device, near, {})->offsetBits().empty());
  }
  CHECK(bytesOf(near, "buckets", 4) < bytesOf(mixed, "buckets", 4));
}

TEST_CASE("Every layout multiplies in the precision that is asked for, on every device") {
  // Values that floats do not hold, in rows of very different lengths.
  SparseMatrix square = irregular(67, 67), wide = irregular(41, 83);
  for (SparseMatrix* a : {&square, &wide})
    for (double& v : a->value) v /= 3.0;
  const auto check = [&](sk::Device& device, const Arithmetic& arithmetic, double roundoff) {
    CAPTURE(device.profile());
    for (const LayoutKind& kind : layoutKinds()) {
      for (const SparseMatrix* a : {&square, &wide}) {
        if (kind.name == "diagonals" && a->rows != a->columns) continue;
        CAPTURE(kind.name, a->rows);
        std::vector<double> x = randomFloats(a->columns);
        for (double& v : x) v /= 7.0;
        const std::unique_ptr<Matrix> matrix = kind.make(device, *a, arithmetic);
        Vector in = device.stream<float>(matrix->domain(), arithmetic.vectors),
               out = device.stream<float>(matrix->range(), arithmetic.vectors),
               xy = device.stream<float>({1}, arithmetic.sums());
        in.writeReals(x);
        matrix->multiply(in, out);
        checkProduct(*a, x, out.readReals(), roundoff);
        // A matrix for floats that stores doubles multiplies in doubles where it is asked to.
        const std::unique_ptr<Matrix> other = kind.make(device, *a, {.matrix = arithmetic.matrix});
        other->multiplyIn(arithmetic, in, out);
        checkProduct(*a, x, out.readReals(), roundoff);
        if (a->rows != a->columns) continue;
        matrix->multiply(in, out, xy);
        checkFold(*a, x, xy.readReals()[0], roundoff);
      }
    }
  };
  const Arithmetic inPairs{.precision = sk::Precision::Extended,
                           .matrix = sk::Storage::Extended,
                           .vectors = sk::Storage::Extended};
  for (sk::Device& device : testDevices()) {
    if (device.profile() != "essl300") check(device, doubles, 0x1p-52);
    check(device, inPairs, 0x1p-43);
  }
}

TEST_CASE("The automatic choice takes a layout that suits the matrix, and unknown names are told") {
  sk::Device device = sk::Device::native();
  const SparseMatrix grid = assemble(poisson({32, 32}));
  std::vector<LayoutCost> costs;
  const std::string layout = makeMatrix(device, grid, "auto", {}, &costs)->layout();
  REQUIRE(costs.size() == 3);  // rows, slices, diagonals
  CHECK(layout == costs.front().layout);
  CHECK(costs[0].bytes <= costs[1].bytes);
  // No clock has a say: the costs are the same numbers again.
  const std::vector<LayoutCost> again = layoutCosts(device, grid, {});
  for (std::size_t i = 0; i < costs.size(); ++i) {
    CHECK(again[i].layout == costs[i].layout);
    CHECK(again[i].bytes == costs[i].bytes);
  }
  CHECK_THROWS_WITH(makeMatrix(device, irregular(5, 5), "csr", {}),
                    "no layout is called 'csr'; there are rows, slices, buckets, diagonals, points, dense");
}

}  // namespace
}  // namespace sk::linear
