// SPDX-License-Identifier: MIT
//
// Promise: native code that computes elements in lanes gives the same bits as element by element. Each kernel gets the same
// elements as a row, which fills lanes, and as a column, whose rows of one element cannot. The column is part of a wider
// stream, because the runtime joins contiguous rows to one row.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "lanes.sk.hpp"
#include "sk/native/code.hpp"
#include "sk/sk.hpp"

namespace {

using Limits = std::numeric_limits<float>;

/// Every row length up to two full vectors plus one, and longer lengths with a remainder.
std::vector<std::int64_t> lengths() {
  std::vector<std::int64_t> result(2 * sk::native::mostLanes + 1);
  std::iota(result.begin(), result.end(), 1);
  result.insert(result.end(), {64, 65, 143, 300});
  return result;
}

template <class T>
sk::Stream<T> streamOf(sk::Device& device, const sk::Shape& shape, const std::vector<T>& values) {
  auto stream = device.stream<T>(shape);
  stream.write(values);
  return stream;
}

/// Makes streams with the elements of a call in one row, or in a column of a wider stream. Keeps the streams alive.
class Place {
 public:
  Place(std::int64_t count, bool isColumn) : count_(count), isColumn_(isColumn) {}

  template <class T>
  sk::View<T> make(sk::Device& device) {
    auto whole = std::make_shared<sk::Stream<T>>(
        device.stream<T>(isColumn_ ? sk::Shape{count_, 3} : sk::Shape{count_}));
    streams_.push_back(whole);
    return isColumn_ ? whole->domain({0, 1}, {count_, 2}) : whole->domain({0}, {count_});
  }
  template <class T>
  sk::View<T> of(sk::Device& device, const std::vector<T>& values) {
    sk::View<T> view = make<T>(device);
    view.write(values);
    return view;
  }

 private:
  std::int64_t count_;
  bool isColumn_;
  std::vector<std::shared_ptr<void>> streams_;
};

/// The bits of values, with the same bits for every NaN.
template <class T>
std::vector<std::uint32_t> bitsOf(const std::vector<T>& values) {
  std::vector<std::uint32_t> bits;
  const auto add = [&](auto component) {
    if constexpr (std::is_same_v<decltype(component), float>) {
      bits.push_back(std::isnan(component) ? 0x7fc00000U : std::bit_cast<std::uint32_t>(component));
    } else {
      bits.push_back(static_cast<std::uint32_t>(component));
    }
  };
  for (const T& value : values) {
    if constexpr (requires { value.w; }) {
      add(value.x), add(value.y), add(value.z), add(value.w);
    } else if constexpr (requires { value.y; }) {
      add(value.x), add(value.y);
    } else {
      add(value);
    }
  }
  return bits;
}

/// Checks that run(place), which returns a kernel's results, returns the same for a row and a column.
template <class Run>
void sameByLanes(std::int64_t n, const Run& run) {
  INFO(n << " elements");
  Place row(n, false), column(n, true);
  CHECK(run(row) == run(column));
}

std::vector<std::uint32_t> together(std::initializer_list<std::vector<std::uint32_t>> parts) {
  std::vector<std::uint32_t> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

template <class Make>
auto list(std::int64_t n, Make&& make) {
  std::vector<decltype(make(0))> values;
  for (std::int64_t i = 0; i < n; ++i) values.push_back(make(static_cast<int>(i)));
  return values;
}
/// A pseudorandom number.
int scattered(int i) { return static_cast<int>(static_cast<unsigned>(i + 1) * 2654435761U >> 7U); }

template <class Kernel>
void controlIsTheSame(const Kernel& kernel) {
  sk::Device device = sk::Device::native();
  for (const std::int64_t n : lengths()) {
    for (const int most : {0, 1, 5, 25}) {
      sameByLanes(n, [&](Place& place) {
        const auto i = place.of(device, list(n, [](int k) { return k - 3; }));
        const auto c = place.of(device, list(n, [](int k) {
                                  const int a = scattered(k);
                                  return sk::float2{static_cast<float>(a % 64) / 32 - 1.5F,
                                                    static_cast<float>(a / 64 % 64) / 48 - 0.5F};
                                }));
        auto result = place.make<int>(device);
        auto sum = place.make<sk::float2>(device);
        kernel(i, c, most, result, sum);
        return together({bitsOf(result.read()), bitsOf(sum.read())});
      });
    }
  }
}

TEST_CASE("neighbours part ways in loops, jumps and calls") {
  controlIsTheSame(lanes::escape);
  controlIsTheSame(lanes::jumps);
  controlIsTheSame(lanes::outlives);
  controlIsTheSame(lanes::counts);
  controlIsTheSame(lanes::calls);
  controlIsTheSame(lanes::nobody);
}

TEST_CASE("integers are the same side by side at their extremes, too") {
  sk::Device device = sk::Device::native();
  constexpr int least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  const std::vector<int> special{0,  1,  -1,      2,        -2,    7,         -7,  31,
                                 32, 33, 1000003, -1000003, least, least + 1, most};
  const auto pick = [&](int k) { return special[static_cast<std::size_t>(k) % special.size()]; };
  for (const int uniform : {0, -1, 3, least}) {
    sameByLanes(300, [&](Place& place) {
      const auto i = place.of(device, list(300, [](int k) { return k; }));
      const auto a = place.of(device, list(300, pick));
      const auto b = place.of(device, list(300, [&](int k) { return pick(k / 15 + k % 3); }));
      const auto u = place.of(device, list(300, [&](int k) { return static_cast<unsigned>(pick(k / 7)); }));
      auto r = place.make<sk::int4>(device);
      auto s = place.make<sk::uint4>(device);
      auto flag = place.make<bool>(device);
      lanes::integers(i, a, b, u, uniform, r, s, flag);
      return together({bitsOf(r.read()), bitsOf(s.read()), bitsOf(flag.read())});
    });
  }
}

template <class Kernel>
void floatsAreTheSame(const Kernel& kernel) {
  sk::Device device = sk::Device::native();
  const std::vector<float> special{0.0F,
                                   -0.0F,
                                   0.5F,
                                   -0.5F,
                                   1.5F,
                                   2.5F,
                                   -2.5F,
                                   1.0F,
                                   -1.0F,
                                   0.3F,
                                   -0.7F,
                                   8388607.5F,
                                   -8388609.0F,
                                   1e10F,
                                   -1e10F,
                                   3e38F,
                                   1e-40F,
                                   -1e-40F,
                                   2147483648.0F,
                                   4294967296.0F,
                                   Limits::infinity(),
                                   -Limits::infinity(),
                                   Limits::quiet_NaN()};
  const auto n = static_cast<std::int64_t>(special.size() * special.size());
  for (const float z : {0.0F, 0.75F, -3.0F, Limits::infinity(), Limits::quiet_NaN()}) {
    sameByLanes(n, [&](Place& place) {
      const auto i = place.of(device, list(n, [](int k) { return k; }));
      const auto x = place.of(
          device, list(n, [&](int k) { return special[static_cast<std::size_t>(k) % special.size()]; }));
      const auto y = place.of(
          device, list(n, [&](int k) { return special[static_cast<std::size_t>(k) / special.size()]; }));
      auto r = place.make<sk::float4>(device);
      auto s = place.make<sk::float4>(device);
      auto t = place.make<sk::int4>(device);
      kernel(i, x, y, z, r, s, t);
      return together({bitsOf(r.read()), bitsOf(s.read()), bitsOf(t.read())});
    });
  }
}

TEST_CASE("floats are the same side by side at their extremes, too") {
  floatsAreTheSame(lanes::floats);
  floatsAreTheSame(lanes::more);
}

template <class Kernel>
void gathersAreTheSame(const Kernel& kernel) {
  sk::Device device = sk::Device::native();
  const auto a = streamOf(device, {40}, list(40, [](int k) { return static_cast<float>(k * k % 17); }));
  const auto b = streamOf(device, {6, 35}, list(6 * 35, [](int k) {
                            return sk::float2{static_cast<float>(k), static_cast<float>(scattered(k) % 100)};
                          }));
  const auto c = streamOf(device, {33}, list(33, scattered));
  // Inside, around the ends, and far outside.
  for (const int first : {0, -20, 20, 1 << 30, -(1 << 30), std::numeric_limits<int>::max() - 40}) {
    for (const std::int64_t n : lengths()) {
      sameByLanes(n, [&](Place& place) {
        const auto i =
            place.of(device, list(n, [&](int k) {
                       return static_cast<int>(static_cast<unsigned>(first) + static_cast<unsigned>(k));
                     }));
        const auto j = place.of(device, list(n, [&](int k) { return scattered(k) % 60 - 10; }));
        auto r = place.make<float>(device);
        kernel(i, j, a, b, c, r);
        return bitsOf(r.read());
      });
    }
  }
}

TEST_CASE("gathers are the same side by side, with every boundary") {
  gathersAreTheSame(lanes::clamped);
  gathersAreTheSame(lanes::wrapped);
  gathersAreTheSame(lanes::mirrored);
  gathersAreTheSame(lanes::bordered);
}

TEST_CASE("gathers in loops are the same side by side") {
  sk::Device device = sk::Device::native();
  constexpr int count = 90;
  const auto next = streamOf(device, {count}, list(count, [](int k) { return scattered(k) % count; }));
  auto stops = device.stream<bool>({count});
  stops.write(list(count, [](int k) { return static_cast<std::uint8_t>(k % 13 == 5); }));
  const auto weights = streamOf(device, {count}, list(count, [](int k) {
                                  const auto x = static_cast<float>(k);
                                  return sk::float4{x, 1 / (x + 1), -x, 0.1F * x};
                                }));
  for (const std::int64_t n : lengths()) {
    sameByLanes(n, [&](Place& place) {
      const auto i = place.of(device, list(n, [](int k) { return k; }));
      auto last = place.make<int>(device);
      auto sum = place.make<sk::float4>(device);
      lanes::followed(i, next, stops, weights, 30, last, sum);
      return together({bitsOf(last.read()), bitsOf(sum.read())});
    });
  }
}

TEST_CASE("elements side by side know where they are, and their neighbours") {
  sk::Device device = sk::Device::native();
  constexpr std::int64_t rows = 3;
  constexpr int reach = 3;
  for (const std::int64_t columns : lengths()) {
    INFO(columns << " columns");
    const sk::Shape shape{rows, columns};
    const std::vector<int> values = list(rows * columns, [](int k) { return scattered(k) % 1000; });
    const auto a = streamOf(device, shape, values);
    auto r = device.stream<int>(shape);
    auto place = device.stream<sk::int2>(shape);
    lanes::around(a, reach, r, place);
    const auto at = [&](std::int64_t y, std::int64_t x) {
      y = std::clamp<std::int64_t>(y, 0, rows - 1);
      x = std::clamp<std::int64_t>(x, 0, columns - 1);
      return values[static_cast<std::size_t>(y * columns + x)];
    };
    std::vector<int> sums;
    std::vector<std::uint32_t> places;
    for (std::int64_t y = 0; y < rows; ++y) {
      for (std::int64_t x = 0; x < columns; ++x) {
        int sum = 0;
        for (int k = 0; k < reach; ++k) sum += at(y, x - 1) + 10 * at(y + 1, x + 2) + 100 * at(y, x + k);
        sums.push_back(sum);
        places.insert(places.end(), {static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y)});
      }
    }
    CHECK(r.read() == sums);
    CHECK(bitsOf(place.read()) == places);
  }
}

TEST_CASE("gathers that follow the element's index are right side by side, with every boundary") {
  sk::Device device = sk::Device::native();
  constexpr int rows = 3;
  const auto wrapped = [](int i, int n) { return (i % n + n) % n; };
  for (const std::int64_t length : lengths()) {
    const int columns = static_cast<int>(length);
    const sk::Shape shape{rows, columns};
    const std::vector<int> values = list(rows * columns, [](int k) { return scattered(k) % 1000; });
    const auto a = streamOf(device, shape, values);
    const auto line = streamOf(device, {columns}, std::vector<int>(values.begin(), values.begin() + columns));
    const auto wide =
        streamOf(device, {rows, 2 * columns}, list(rows * 2 * columns, [](int k) { return k; }));
    auto r = device.stream<sk::int4>(shape);
    auto own = device.stream<int>(shape);
    const auto at = [&](int y, int x) { return values[static_cast<std::size_t>(y * columns + x)]; };
    for (const int by : {0, 1, -3, 20}) {
      INFO(columns << " columns, by " << by);
      lanes::follows(a, a, line, a, by, sk::stride(wide), r, own);
      std::vector<std::uint32_t> expected;
      std::vector<int> owns;
      for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
          int sums[4] = {};
          for (int k = 0; k < 2; ++k) {
            sums[0] += at(std::min(y + k, rows - 1), std::clamp(x + by - 2 * k, 0, columns - 1));
            sums[1] += at(wrapped(y - by, rows), wrapped(x - by, columns));
            const int mirrored = wrapped(k + x + by, 2 * columns);
            sums[2] += at(0, std::min(mirrored, 2 * columns - 1 - mirrored));
            const bool isInside = k + by >= 0 && k + by < rows && x + by >= 0 && x + by < columns;
            sums[3] += isInside ? at(k + by, x + by) : -7;
          }
          for (const int sum : sums) expected.push_back(static_cast<std::uint32_t>(sum));
          owns.push_back(y * 2 * columns + 2 * x + at(y, wrapped(2 * x, columns)));
        }
      }
      CHECK(bitsOf(r.read()) == expected);
      CHECK(own.read() == owns);
    }
  }
}

/// Compares a kernel's results for all rows together with those for each row alone. call(top, outputs ...) calls the kernel
/// for rows from `top` on.
template <class... Results, class Call>
void checkRows(sk::Device& device, std::int64_t rows, std::int64_t columns, Call&& call) {
  const auto compare = [&](auto together, auto alone) {
    CHECK(bitsOf(together.read()) == bitsOf(alone.read()));
  };
  std::tuple<sk::Stream<Results>...> together{device.stream<Results>({rows, columns})...};
  std::tuple<sk::Stream<Results>...> alone{device.stream<Results>({rows, columns})...};
  std::apply([&](auto&... results) { call(0, results.domain({0, 0}, {rows, columns})...); }, together);
  for (std::int64_t y = 0; y < rows; ++y) {
    std::apply(
        [&](auto&... results) { call(static_cast<int>(y), results.domain({y, 0}, {y + 1, columns})...); },
        alone);
  }
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (compare(std::move(std::get<I>(together)), std::move(std::get<I>(alone))), ...);
  }(std::index_sequence_for<Results...>());
}

TEST_CASE("rows that are computed together have every bit of rows computed alone") {
  sk::Device device = sk::Device::native();
  constexpr int depth = 13;
  for (const std::int64_t rows : {1, 2, 4, 7, 8, 9, 17, 24}) {
    for (const std::int64_t columns : {1, 5, 16, 31, 64, 67, 130}) {
      INFO(rows << " x " << columns);
      const auto number = [](int k) { return static_cast<float>(scattered(k) % 1000) / 7; };
      const auto fours = [&](int k) {
        return sk::float4{number(k), number(k + 1), number(k + 7), -number(k + 3)};
      };
      const auto small = [](int k) { return scattered(k) % 17 - 3; };
      const int left = static_cast<int>(rows) * depth, right = static_cast<int>(columns) * depth;
      const auto a = streamOf(device, {rows, depth}, list(left, number));
      const auto b = streamOf(device, {depth, columns}, list(right, number));
      checkRows<float>(device, rows, columns, [&](int top, auto r) { lanes::product(top, a, b, r); });
      const auto a4 = streamOf(device, {rows, depth}, list(left, fours));
      const auto b4 = streamOf(device, {depth, columns}, list(right, fours));
      auto zero = device.stream<sk::float4>({1, columns});
      zero.write(std::vector<sk::float4>(static_cast<std::size_t>(columns)));
      checkRows<sk::float4>(device, rows, columns,
                            [&](int top, auto r) { lanes::blocks(top, a4, b4, zero, r); });
      const auto ai = streamOf(device, {rows, depth}, list(left, small));
      const auto bi = streamOf(device, {depth, columns}, list(right, small));
      checkRows<int, sk::float2>(device, rows, columns,
                                 [&](int top, auto r, auto s) { lanes::parting(top, ai, bi, 10, r, s); });
    }
  }
}

TEST_CASE("a product of matrices is what a loop gives") {
  sk::Device device = sk::Device::native();
  constexpr std::size_t rows = 19, depth = 21, columns = 83;
  const std::vector<float> a =
      list(rows * depth, [](int k) { return static_cast<float>(scattered(k) % 100) / 3; });
  const std::vector<float> b =
      list(depth * columns, [](int k) { return static_cast<float>(scattered(k) % 77) / 9; });
  auto r = device.stream<float>({rows, columns});
  lanes::product(0, streamOf(device, {rows, depth}, a), streamOf(device, {depth, columns}, b), r);
  std::vector<float> expected(rows * columns);
  for (std::size_t y = 0; y < rows; ++y) {
    for (std::size_t k = 0; k < depth; ++k) {
      for (std::size_t x = 0; x < columns; ++x)
        expected[y * columns + x] += a[y * depth + k] * b[k * columns + x];
    }
  }
  CHECK(bitsOf(r.read()) == bitsOf(expected));
}

const std::vector<int> walkedSizes{1, 7, 8, 9, 15, 16, 17, 33, 100};

TEST_CASE("loops that walk along rows give what loops for single elements give") {
  sk::Device device = sk::Device::native();
  const auto number = [](int k) { return static_cast<float>(scattered(k) % 1000) / 7 - 50; };
  for (const int rows : walkedSizes) {
    for (const int columns : walkedSizes) {
      INFO(rows << " x " << columns);
      const auto a = list(rows * columns, number);
      const auto pairs = list(rows * columns, [&](int k) { return sk::float2{number(k), number(k + 5)}; });
      const auto x = list(columns, [&](int k) { return number(k + 1000); });
      auto y = device.stream<float>({rows});
      auto y2 = device.stream<sk::float2>({rows});
      lanes::walked(streamOf(device, {rows, columns}, a), streamOf(device, {columns}, x), y);
      lanes::walkedFlat(streamOf(device, {rows * columns}, pairs), static_cast<unsigned>(columns),
                        streamOf(device, {columns}, x), y2);
      std::vector<float> expected;
      std::vector<sk::float2> expected2;
      for (std::size_t row = 0; row < static_cast<std::size_t>(rows); ++row) {
        float sum = 0;
        sk::float2 sums{0, 0};
        for (std::size_t k = 0; k < x.size(); ++k) {
          sum += a[row * x.size() + k] * x[k];
          sums.x += pairs[row * x.size() + k].x * x[k];
          sums.y += pairs[row * x.size() + k].y * x[k];
        }
        expected.push_back(sum);
        expected2.push_back(sums);
      }
      CHECK(bitsOf(y.read()) == bitsOf(expected));
      CHECK(bitsOf(y2.read()) == bitsOf(expected2));
    }
  }
}

TEST_CASE("loops that walk along rows and over their ends are right, with every boundary") {
  sk::Device device = sk::Device::native();
  const auto wrapped = [](int i, int n) { return (i % n + n) % n; };
  for (const int rows : walkedSizes) {
    for (const int columns : walkedSizes) {
      const auto values = list(rows * columns, [](int k) { return scattered(k) % 1000; });
      const auto a = streamOf(device, {rows, columns}, values);
      const auto at = [&](int y, int x) { return values[static_cast<std::size_t>(y * columns + x)]; };
      auto r = device.stream<sk::int4>({rows});
      for (const int by : {0, 1, -3, 20}) {
        INFO(rows << " x " << columns << ", by " << by);
        const int n = columns + 25;
        lanes::walkedOver(a, a, a, a, by, n, r);
        std::vector<std::uint32_t> expected;
        for (int row = 0; row < rows; ++row) {
          std::uint32_t sums[4] = {};
          for (int k = 0; k < n; ++k) {
            const int y = row - by / 2, x = k - row;
            const int mirrored = wrapped(by + k, 2 * columns);
            const int read[4] = {at(std::clamp(row - by, 0, rows - 1), std::clamp(k - by, 0, columns - 1)),
                                 at(wrapped(row + by, rows), wrapped(k + row % 5 - by, columns)),
                                 at(row, std::min(mirrored, 2 * columns - 1 - mirrored)),
                                 y >= 0 && y < rows && x >= 0 && x < columns ? at(y, x) : -7};
            for (int i = 0; i < 4; ++i) sums[i] = sums[i] * 3 + static_cast<std::uint32_t>(read[i]);
          }
          for (const std::uint32_t sum : sums) expected.push_back(sum);
        }
        CHECK(bitsOf(r.read()) == expected);
      }
    }
  }
}

TEST_CASE("loops that walk along rows are left and continued where a loop for one element is") {
  sk::Device device = sk::Device::native();
  for (const int rows : walkedSizes) {
    for (const int columns : walkedSizes) {
      const auto a = list(rows * columns, [](int k) { return static_cast<float>(scattered(k) % 100) / 3; });
      const auto b = list(rows * columns, [](int k) { return scattered(k + 7) % 1000; });
      auto y = device.stream<float>({rows});
      auto count = device.stream<int>({rows});
      for (const float most : {0.0F, 100.0F, 1e9F}) {
        for (const int last : {-1, 5, 16, 30}) {
          INFO(rows << " x " << columns << ", most " << most << ", last " << last);
          const sk::Shape shape{rows, columns};
          lanes::walkedPartly(streamOf(device, shape, a), streamOf(device, shape, b), most, last, y, count);
          std::vector<float> sums;
          std::vector<int> counts;
          for (int row = 0; row < rows; ++row) {
            float sum = 0;
            int counted = 0;
            for (int k = 0; k < columns && k != last; ++k) {
              const auto i = static_cast<std::size_t>(row * columns + k);
              if (b[i] % 3 == 0) continue;
              sum += a[i];
              if (sum > most) break;
              counted += b[i];
            }
            sums.push_back(sum);
            counts.push_back(counted);
          }
          CHECK(bitsOf(y.read()) == bitsOf(sums));
          CHECK(count.read() == counts);
        }
      }
    }
  }
}

TEST_CASE("rows of different lengths sum their own elements, with columns outside at the nearest") {
  sk::Device device = sk::Device::native();
  constexpr int size = 200;
  const auto x = list(size, [](int k) { return static_cast<float>(scattered(k) % 100) / 3; });
  std::vector<int> starts{0}, columns;
  std::vector<float> values, expected;
  for (int row = 0; row < size; ++row) {
    float sum = 0;
    for (int k = 0; k < scattered(row) % 13; ++k) {
      columns.push_back(scattered(row * 16 + k) % (size + 20) - 10);
      values.push_back(static_cast<float>(scattered(row + k * 7) % 100) / 7);
      sum += values.back() * x[static_cast<std::size_t>(std::clamp(columns.back(), 0, size - 1))];
    }
    starts.push_back(static_cast<int>(columns.size()));
    expected.push_back(sum);
  }
  const auto count = static_cast<std::int64_t>(columns.size());
  auto y = device.stream<float>({size});
  lanes::sparseRows(streamOf(device, {size + 1}, starts), streamOf(device, {count}, columns),
                    streamOf(device, {count}, values), streamOf(device, {size}, x), y);
  CHECK(bitsOf(y.read()) == bitsOf(expected));
}

}  // namespace
