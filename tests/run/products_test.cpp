// SPDX-License-Identifier: MIT
//
// Promise: native code that computes blocks of rows and columns of a product together, from panels of columns where these pay,
// gives every bit of rows that are computed alone, with and without contraction, for sizes that no block divides.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

#include <catch2/catch.hpp>

#include "products.sk.hpp"
#include "sk/sk.hpp"

namespace {

/// A pseudorandom number.
int scattered(std::int64_t i) { return static_cast<int>(static_cast<unsigned>(i + 1) * 2654435761U >> 7U); }
float number(std::int64_t i) { return static_cast<float>(scattered(i) % 1000) / 7 - 50; }

template <class T>
T valueOf(std::int64_t i) {
  if constexpr (requires(T value) { value.z; }) {
    return {number(i), number(i + 3), number(i + 7)};
  } else if constexpr (requires(T value) { value.y; }) {
    return {number(i), number(i + 3)};
  } else if constexpr (requires(T value) { value.exponent; }) {
    return {number(i), scattered(i) % 100};
  } else if constexpr (std::is_floating_point_v<T>) {
    return number(i);
  } else {
    return static_cast<T>(scattered(i));
  }
}

template <class T>
sk::Stream<T> filled(sk::Device& device, const sk::Shape& shape, int seed) {
  auto stream = device.stream<T>(shape);
  std::vector<T> values;
  for (std::int64_t i = 0; i < stream.size(); ++i) values.push_back(valueOf<T>(i + seed));
  stream.write(values);
  return stream;
}

/// True if all bits are equal but those of NaNs.
bool areEqual(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) ||
         (std::isnan(a) && std::isnan(b));
}
bool areEqual(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
template <class T>
bool areEqual(const T& a, const T& b) {
  if constexpr (requires { a.w; }) {
    return areEqual(a.x, b.x) && areEqual(a.y, b.y) && areEqual(a.z, b.z) && areEqual(a.w, b.w);
  } else if constexpr (requires { a.z; }) {
    return areEqual(a.x, b.x) && areEqual(a.y, b.y) && areEqual(a.z, b.z);
  } else if constexpr (requires { a.y; }) {
    return areEqual(a.x, b.x) && areEqual(a.y, b.y);
  } else if constexpr (requires { a.exponent; }) {
    return areEqual(a.factor, b.factor) && a.exponent == b.exponent;
  } else {
    return a == b;
  }
}

/// Compares the results of all rows together with those of each row alone. call(top, r) computes rows from `top` on.
template <class T, class Call>
void checkRows(sk::Device& device, std::int64_t rows, std::int64_t columns, Call&& call) {
  auto together = device.stream<T>({rows, columns}), alone = device.stream<T>({rows, columns});
  call(0, together.domain({0, 0}, {rows, columns}));
  for (std::int64_t y = 0; y < rows; ++y) call(static_cast<int>(y), alone.domain({y, 0}, {y + 1, columns}));
  const std::vector<T> a = together.read(), b = alone.read();
  std::int64_t different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) different += areEqual(a[i], b[i]) ? 0 : 1;
  CHECK(different == 0);
}

/// Rows enough for panels at every level of the CPU, and columns around the widths of panels.
constexpr std::int64_t manyRows = 211;
const std::vector<std::int64_t> columnCounts{1, 2, 7, 31, 32, 33, 64, 67, 101};

template <class T, class Kernel>
void checkProducts(const Kernel& kernel) {
  sk::Device device = sk::Device::native();
  for (const std::int64_t columns : columnCounts) {
    for (const int depth : {0, 1, 2, 37}) {
      for (const std::int64_t rows : {std::int64_t{3}, std::int64_t{23}, manyRows}) {
        CAPTURE(rows, columns, depth);
        const auto a = filled<T>(device, {rows, 40}, 1), b = filled<T>(device, {40, columns}, 7000);
        checkRows<T>(device, rows, columns, [&](int top, auto r) { kernel(top, depth, a, b, r); });
      }
    }
  }
}

TEST_CASE("blocks of products have every bit of rows computed alone") {
  using namespace products;
  SECTION("float") { checkProducts<float>(product); }
  SECTION("float, contracted") { checkProducts<float>(product.with({.contraction = sk::Contraction::Fast})); }
  SECTION("int") { checkProducts<int>(product); }
  SECTION("uint") { checkProducts<unsigned>(product); }
  SECTION("float2") { checkProducts<sk::float2>(product); }
  SECTION("float3") { checkProducts<sk::float3>(product); }
  SECTION("double") { checkProducts<double>(product); }
  SECTION("struct") { checkProducts<Term>(terms); }
}

TEST_CASE("blocks of products of storage types have every bit of rows computed alone") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t columns : columnCounts) {
    CAPTURE(columns);
    auto a = device.stream<sk::half>({manyRows, 40});
    auto b = device.stream<std::uint8_t>({40, columns});
    std::vector<sk::half> halves;
    std::vector<std::uint8_t> bytes;
    for (std::int64_t i = 0; i < a.size(); ++i) halves.push_back(sk::half(number(i)));
    for (std::int64_t i = 0; i < b.size(); ++i) bytes.push_back(static_cast<std::uint8_t>(scattered(i)));
    a.write(halves);
    b.write(bytes);
    checkRows<float>(device, manyRows, columns, [&](int top, auto r) { products::narrow(top, 39, a, b, r); });
  }
}

TEST_CASE("loops whose indices leave gathers give what boundary modes say") {
  sk::Device device = sk::Device::native();
  constexpr int depth = 11;
  const auto a = filled<float>(device, {manyRows, 64}, 1);
  for (const std::int64_t columns : {std::int64_t{5}, std::int64_t{33}, std::int64_t{64}}) {
    const auto b = filled<float>(device, {depth, columns}, 5);
    for (const int first : {-3, -1, 0, 1, 2}) {
      for (const int last : {-1, 1, depth - 2, depth - 1, depth, depth + 5}) {
        CAPTURE(columns, first, last);
        checkRows<sk::float4>(device, manyRows, columns,
                              [&](int top, auto r) { products::beyond(top, first, last, a, b, b, b, b, r); });
      }
    }
    // the same of one element, in the plainest words
    const std::vector<float> left = a.read(), right = b.read();
    auto r = device.stream<sk::float4>({manyRows, columns});
    products::beyond(0, -2, depth, a, b, b, b, b, r);
    const std::int64_t y = manyRows - 2, x = columns - 1;
    sk::float4 expected{0, 0, 0, 0};
    for (int k = -2; k <= depth; ++k) {
      const float factor = left[static_cast<std::size_t>(y * 64 + std::max(k, 0))];
      const auto at = [&](int row) { return right[static_cast<std::size_t>(row * columns + x)]; };
      const auto mirrored = [](int row) {
        return row < 0 ? -1 - row : row >= depth ? 2 * depth - 1 - row : row;
      };
      expected.x += factor * at(std::clamp(k, 0, depth - 1));
      expected.y += factor * at((k - 1 + depth) % depth);
      expected.z += factor * at(mirrored(k + 1));
      expected.w += factor * (k < 0 || k >= depth ? 3.5F : at(k));
    }
    CHECK(areEqual(r.read()[static_cast<std::size_t>(y * columns + x)], expected));
  }
}

TEST_CASE("gathers that are wider or narrower than the domain keep their boundary modes") {
  sk::Device device = sk::Device::native();
  const auto a = filled<float>(device, {manyRows, 40}, 1);
  for (const std::int64_t width : {1, 30, 63, 64, 65, 100}) {
    CAPTURE(width);
    const auto b = filled<float>(device, {40, width}, 5);
    checkRows<float>(device, manyRows, 64, [&](int top, auto r) { products::product(top, 40, a, b, r); });
    checkRows<sk::float4>(device, manyRows, 64,
                          [&](int top, auto r) { products::beyond(top, 0, 30, a, b, b, b, b, r); });
  }
}

TEST_CASE("loops of other forms, and loops that read other columns, have every bit of rows computed alone") {
  sk::Device device = sk::Device::native();
  for (const std::int64_t columns :
       {std::int64_t{1}, std::int64_t{33}, std::int64_t{96}, std::int64_t{512}}) {
    CAPTURE(columns);
    const auto a = filled<float>(device, {manyRows, 512}, 1), b = filled<float>(device, {512, columns}, 5),
               c = filled<float>(device, {manyRows, columns}, 9),
               square = filled<float>(device, {512, 512}, 3);
    for (const unsigned depth : {0U, 5U, 39U, 41U, 70U}) {
      for (const unsigned from : {0U, 4U, 0xfffffffeU}) {
        CAPTURE(depth, from);
        checkRows<float>(device, manyRows, columns,
                         [&](int top, auto r) { products::skipping(top, depth, from, a, b, r); });
      }
    }
    for (const int right : {-40, 1, 40}) {
      checkRows<float>(device, manyRows, columns,
                       [&](int top, auto r) { products::beside(top, 50, right, a, b, r); });
    }
    checkRows<sk::float2>(device, manyRows, columns,
                          [&](int top, auto r) { products::transposed(top, 50, square, square, r); });
  }
}

TEST_CASE("gathers of which copies are read keep their neighbours") {
  sk::Device device = sk::Device::native();
  constexpr std::int64_t columns = 512;  // rows of a page half
  const auto a = filled<float>(device, {manyRows, 600}, 1), b = filled<float>(device, {600, columns}, 5),
             c = filled<float>(device, {600, columns}, 9);
  auto r = device.stream<float>({600, columns}), sums = device.stream<float>({600, columns});
  const auto wide = filled<float>(device, {600, 600}, 1);
  products::around(0, 600, wide, b, c, r);
  products::around(0, 0, wide, b, c, sums);
  const std::vector<float> left = wide.read(), right = b.read(), column = c.read(), start = sums.read(),
                           found = r.read();
  for (const std::int64_t y : {0, 17, 599}) {
    for (const std::int64_t x : {0, 31, 32, 511}) {
      float sum = start[static_cast<std::size_t>(y * columns + x)];
      const auto at = [&](const std::vector<float>& m, std::int64_t row, std::int64_t i) {
        return m[static_cast<std::size_t>(std::clamp<std::int64_t>(row, 0, 599) * columns +
                                          std::clamp<std::int64_t>(i, 0, columns - 1))];
      };
      CHECK(sum == at(column, y, x + 1) - at(column, y + 1, x - 1));
      for (std::int64_t k = 0; k < 600; ++k)
        sum += left[static_cast<std::size_t>(y * 600 + k)] * at(right, k, x);
      for (std::int64_t k = 0; k < 600; ++k) sum += at(column, k, x);
      CAPTURE(y, x);
      CHECK(areEqual(found[static_cast<std::size_t>(y * columns + x)], sum));
    }
  }
}

TEST_CASE("products of layers, of views and of parts are those of whole matrices") {
  sk::Device device = sk::Device::native();
  constexpr std::int64_t depth = 37, columns = 67;
  const auto a = filled<float>(device, {2, manyRows, depth}, 1),
             b = filled<float>(device, {2, depth, columns}, 5);
  auto whole = device.stream<float>({2, manyRows, columns});
  products::layers(0, a, b, whole);
  const std::vector<float> layers = whole.read();
  auto wide = filled<float>(device, {depth + 9, columns + 20}, 77);
  auto tall = filled<float>(device, {manyRows + 3, depth + 4}, 78);
  for (std::int64_t z = 0; z < 2; ++z) {
    auto r = device.stream<float>({manyRows + 5, columns + 11});
    auto left = tall.domain({2, 1}, {2 + manyRows, 1 + depth});
    auto right = wide.domain({4, 13}, {4 + depth, 13 + columns});
    const auto layerOf = [&](const sk::Stream<float>& from, std::int64_t size) {
      const std::vector<float> all = from.read();
      return std::vector<float>(all.begin() + z * size, all.begin() + (z + 1) * size);
    };
    left.write(layerOf(a, manyRows * depth));
    right.write(layerOf(b, depth * columns));
    auto view = r.domain({3, 5}, {3 + manyRows, 5 + columns});
    products::product(0, depth, left, right, view);
    const std::vector<float> found = view.read();
    const auto size = manyRows * columns;
    CHECK(found == std::vector<float>(layers.begin() + z * size, layers.begin() + (z + 1) * size));
  }
}

TEST_CASE("a product in a recorded loop reads what its matrices hold in each iteration") {
  sk::Device device = sk::Device::native();
  constexpr std::int64_t size = 193;
  auto a = filled<float>(device, {size, size}, 1), b = filled<float>(device, {size, size}, 2),
       r = device.stream<float>({size, size});
  std::vector<float> small;
  for (const float value : a.read()) small.push_back(value / 1000);
  a.write(small);
  const std::vector<float> start = b.read();
  const auto step = [&] {
    products::product(0, size, a, b, r);
    products::product(0, size, a, r, b);
  };
  for (int i = 0; i < 3; ++i) step();
  const std::vector<float> expected = b.read();
  b.write(start);
  sk::Loop loop = device.record(step);
  loop.repeat(3);
  CHECK(b.read() == expected);
}

}  // namespace
