// SPDX-License-Identifier: MIT
//
// Reduces to smaller streams: rows, columns, blocks of every rank; views as input and output; sums that round, and special
// values.
#include <cmath>
#include <numeric>

#include "reduces.sk.hpp"
#include "support/devices.hpp"
#include "support/folds.hpp"

using namespace run_tests;
using sk::float4;

namespace {

reduces::Affine affineAt(std::size_t i) {
  const auto k = static_cast<std::uint32_t>(i);
  return {valueAt<std::uint32_t>(k) | 1u, valueAt<std::uint32_t>(k + 5)};
}

struct Row {
  sk::Shape input, output;
};
const std::vector<Row> rows = {
    {{1}, {1}},
    {{12}, {12}},
    {{12}, {4}},
    {{1021}, {1}},
    {{1020}, {51}},
    {{3900}, {130}},
    {{7, 9}, {7, 9}},
    {{7, 9}, {7, 1}},
    {{7, 9}, {1, 9}},
    {{7, 9}, {1, 1}},
    {{60, 66}, {4, 11}},
    {{67, 60}, {67, 1}},
    {{67, 60}, {1, 60}},
    {{1, 1021}, {1, 1021}},
    {{1024, 2}, {2, 2}},
    {{4, 6, 10}, {2, 3, 5}},
    {{4, 6, 10}, {1, 6, 1}},
    {{5, 1, 70}, {5, 1, 1}},
    {{2, 4, 6, 8}, {2, 1, 3, 4}},
    {{2, 4, 6, 8}, {1, 1, 1, 1}},
};
const auto composeTo = [](reduces::Affine& r, const reduces::Affine& f) { r = {f.a * r.a, f.a * r.b + f.b}; };

std::string differenceOfMaps(const std::vector<reduces::Affine>& actual,
                             const std::vector<reduces::Affine>& expected) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (actual[i].a != expected[i].a || actual[i].b != expected[i].b)
      return "element " + std::to_string(i) + " differs";
  }
  return actual.size() == expected.size() ? "" : "another number of elements";
}

}  // namespace

TEST_CASE("a reduce to a stream folds each block, in order") {
  onEveryLayout([](sk::Device& device) {
    for (const Row& row : rows) {
      INFO(sk::toString(row.input) << " to " << sk::toString(row.output));
      const HostArray<reduces::Affine> f(row.input, affineAt);
      const auto expected = foldBlocks(f, row.output, reduces::Affine{1, 0}, composeTo);
      auto maps = device.stream<reduces::Affine>(row.output);
      reduces::compose(f.on(device), maps);
      CHECK(differenceOfMaps(maps.read(), expected.elements()) == "");

      if (row.output.size() > 2) continue;  // the rest tests other programs, not other layouts
      reduces::composeSeeded(f.on(device), maps);
      CHECK(differenceOfMaps(maps.read(), expected.elements()) == "");
      const HostArray<float> x(row.input, smallAt);
      auto counts = device.stream<int>(row.output);
      reduces::countPositive(x.on(device), counts);
      CHECK(difference(counts.read(),
                       foldBlocks(x, row.output, 0, [](int& r, float v) { r += v > 0; }).elements()) == "");
    }
  });
}

TEST_CASE("where there are thousands of rows, work groups fold two of them each") {
  sk::Device& device = run_tests::device("glsl430", 0);
  constexpr std::int64_t height = 2050, width = 512;
  std::vector<int> elements(static_cast<std::size_t>(height * width)), expected(height);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    elements[i] = valueAt<int>(static_cast<std::uint32_t>(i)) % 1000;
    expected[i / width] += elements[i];
  }
  auto x = device.stream<int>({height, width});
  x.write(elements);
  auto sums = device.stream<int>({height, 1});
  reduces::sumInt(x, sums);
  CHECK(sums.read() == expected);
  auto more = device.stream<int>({height + 2, 3});
  more.fill(7);
  auto middle = more.domain({1, 1}, {height + 1, 2});
  reduces::sumInt(x, middle);
  CHECK(middle.read() == expected);
  CHECK(more.domain({0, 0}, {1, 3}).read() == std::vector<int>(3, 7));
  CHECK(more.domain({height + 1, 0}, {height + 2, 3}).read() == std::vector<int>(3, 7));
}

TEST_CASE("an input of nothing fills its output with the identity") {
  onSomeLayouts([](sk::Device& device) {
    auto sums = device.stream<float>({3, 1});
    reduces::product(device.stream<float>({3, 0}), sums);
    CHECK(sums.read() == std::vector<float>{1, 1, 1});
    auto hits = device.stream<reduces::Hit>({1});
    CHECK_THROWS_AS(reduces::nearest(device.stream<reduces::Hit>({0}), hits), sk::Error);
    auto none = device.stream<float>({0, 1});
    reduces::sum(device.stream<float>({0, 7}), none);
    CHECK(none.read().empty());
  });
}

TEST_CASE("views are folded, and folded into") {
  onSomeLayouts([](sk::Device& device) {
    for (const auto& [shape, begin, end] :
         {std::tuple{sk::Shape{900}, sk::Index{7}, sk::Index{883}},
          std::tuple{sk::Shape{40, 80}, sk::Index{3, 5}, sk::Index{33, 77}},
          std::tuple{sk::Shape{6, 7, 30}, sk::Index{1, 2, 3}, sk::Index{5, 6, 27}}}) {
      INFO(sk::toString(begin) << " to " << sk::toString(end) << " of " << sk::toString(shape));
      const HostArray<reduces::Affine> whole(shape, affineAt);
      auto stream = whole.on(device);
      const auto part = stream.domain(begin, end);
      const HostArray<reduces::Affine> f(part.shape(), [&, first = begin](std::size_t i) {
        return whole[inside(first, positionOf(part.shape(), i))];
      });
      const auto all = foldBox(f, {}, part.shape(), reduces::Affine{1, 0}, composeTo);
      const auto value = reduces::compose(part);
      CHECK(differenceOfMaps({value}, {all}) == "");

      sk::Shape half = part.shape();
      for (int d = 0; d < half.rank(); ++d) half = half.with(d, half[d] / 2);
      sk::Index corner = sk::Index::origin(half.rank());
      for (int d = 0; d < half.rank(); ++d) corner[d] = half[d];
      const auto expected = foldBlocks(f, half, reduces::Affine{1, 0}, composeTo);
      auto room = device.stream<reduces::Affine>(shape);
      const auto target = room.domain(sk::Index::origin(half.rank()), corner);
      reduces::compose(part, target);
      CHECK(differenceOfMaps(target.read(), expected.elements()) == "");
      // Into a part of the stream that is folded.
      const auto own = stream.domain(sk::Index::origin(half.rank()), corner);
      reduces::composeSeeded(part, own);
      CHECK(differenceOfMaps(own.read(), expected.elements()) == "");
    }
  });
}

TEST_CASE("a chain of kernels and reduces: variance of rows, then the largest") {
  onSomeLayouts([](sk::Device& device) {
    const HostArray<float> x({31, 61}, smallAt);
    const auto stream = x.on(device);
    auto moments = device.stream<reduces::Moments>({31, 1});
    reduces::moments(stream, moments);
    const auto read = moments.read();
    for (std::int64_t row = 0; row < 31; ++row) {
      float sum = 0, squares = 0;
      for (std::int64_t column = 0; column < 61; ++column) {
        sum += x[{row, column}];
        squares += x[{row, column}] * x[{row, column}];
      }
      CHECK(read[static_cast<std::size_t>(row)].sum == sum);
      CHECK(read[static_cast<std::size_t>(row)].squares == squares);
      CHECK(read[static_cast<std::size_t>(row)].count == 61);
    }
    auto columns = device.stream<float>({1, 61});
    reduces::sum(stream, columns);
    CHECK(reduces::sum(columns) == reduces::sum(stream));
  });
}

TEST_CASE("sums of floats that round stay within the bound of their tree") {
  onEveryTarget([](sk::Device& device) {
    // N. J. Higham, "The accuracy of floating point summation" (1993): |error| <= d u sum|x| if no element
    // passes through more than d additions; up to 3 levels of up to 64 elements each give d < 256.
    constexpr double u = 5.9604644775390625e-8;
    std::vector<float> x(65537);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::sin(static_cast<float>(i)) * 1000.1f;
    const double exact = std::accumulate(x.begin(), x.end(), 0.0);
    const double size =
        std::accumulate(x.begin(), x.end(), 0.0, [](double s, float v) { return s + std::fabs(v); });
    const float actual = reduces::sum(streamOf<float>(device, x));
    CHECK(std::fabs(actual - exact) <= 256 * u * size);
    const float tenths = reduces::sum(streamOf<float>(device, {257, 255}, std::vector<float>(65535, 0.1f)));
    CHECK(std::fabs(tenths - 65535 * double{0.1f}) <= 256 * u * 6554);
  });
}

TEST_CASE("infinity survives a sum, and unlike infinities give NaN") {
  onEveryTarget([](sk::Device& device) {
    std::vector<float> x(1021, 1.0f);
    x[700] = INFINITY;
    CHECK(reduces::sum(streamOf<float>(device, x)) == INFINITY);
    CHECK(reduces::least(streamOf<float>(device, x)) == 1);
    x[3] = -INFINITY;
    CHECK(std::isnan(reduces::sum(streamOf<float>(device, x))));
    CHECK(reduces::least(streamOf<float>(device, x)) == -INFINITY);
    x[3] = NAN;
    CHECK(std::isnan(reduces::sum(streamOf<float>(device, x))));
  });
}
