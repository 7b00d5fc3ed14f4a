// SPDX-License-Identifier: MIT
//
// Promises: an element of a scan's result folds the elements up to it, in row-major order over the stream or along a
// dimension; it may be stored where an input is; and it has the same bits for any number of threads.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "scans.sk.hpp"
#include "sk/native/parallel.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"
#include "support/streams.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

constexpr sk::CallOptions exclusive{.scan = sk::Scan::Exclusive};

std::vector<int> numbers(std::size_t count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> some(-9, 9);
  std::vector<int> x(count);
  std::ranges::generate(x, [&] { return some(random); });
  return x;
}

/// The scan by a plain loop, along a dimension or, without one, over all elements.
template <class T, class X, class Fold>
std::vector<T> scanned(const std::vector<X>& x, const T& identity, const Fold& fold, bool isExclusive = false,
                       const sk::Shape& shape = {}, int along = -1) {
  std::size_t step = 1, length = x.size();
  if (along >= 0) {
    length = static_cast<std::size_t>(shape[along]);
    for (int d = along + 1; d < shape.rank(); ++d) step *= static_cast<std::size_t>(shape[d]);
  }
  std::vector<T> results(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool starts = i / step % length == 0;
    const std::size_t before = i - step;
    const T carry = starts ? identity : isExclusive ? fold(results[before], x[before]) : results[before];
    results[i] = isExclusive ? carry : fold(carry, x[i]);
  }
  return results;
}

const auto plus = [](auto a, auto b) {
  if constexpr (std::is_same_v<decltype(a), int>)
    return static_cast<int>(static_cast<unsigned>(a) + static_cast<unsigned>(b));
  else
    return a + b;
};

TEST_CASE("integers of any length are scanned, with or without the element itself") {
  onEveryTarget([](sk::Device& device) {
    for (const std::size_t n : {0U, 1U, 2U, 13U, 65537U, 1048579U}) {
      INFO(n << " elements");
      const std::vector<int> x = numbers(n);
      const auto in = streamOf(device, x);
      auto out = streamOf(device, std::vector<int>(n, 7));
      scans::prefix(in, out);
      CHECK(out.read() == scanned(x, 0, plus));
      scans::prefix.with(exclusive)(in, out);
      CHECK(out.read() == scanned(x, 0, plus, true));
      scans::prefix(in, out);
      scans::prefix.with(exclusive)(out, out);  // in place
      CHECK(out.read() == scanned(scanned(x, 0, plus), 0, plus, true));
    }
  });
}

TEST_CASE("streams are scanned as a whole or along each dimension") {
  onEveryTarget([](sk::Device& device) {
    const bool isNative = &device == &run_tests::device("native");
    const std::vector<sk::Shape> all = {{50},    {1, 1},    {37, 41},    {3, 5000},    {5000, 3},     {1, 70},
                                        {70, 1}, {5, 6, 7}, {3, 1, 700}, {2, 3, 4, 5}, {3, 70, 1, 90}};
    // GL compiles programs for each rank and direction: a sample has all of them, and lines of one pass and of several.
    const std::vector<sk::Shape> some = {{37, 41}, {3, 5000}, {5, 6, 7}, {3, 70, 1, 90}};
    for (const sk::Shape& shape : isNative ? all : some) {
      const std::vector<int> x = numbers(static_cast<std::size_t>(shape.size()));
      const auto in = streamOf(device, x, shape);
      auto out = device.stream<int>(shape);
      for (int along = -1; along < shape.rank(); ++along) {
        for (const bool isExclusive : {false, true}) {
          INFO("rank " << shape.rank() << ", " << shape.size() << " elements, along " << along
                       << ", exclusive " << isExclusive);
          sk::CallOptions options{.scan = isExclusive ? sk::Scan::Exclusive : sk::Scan::Inclusive};
          if (along >= 0) options.along = along;
          scans::prefix.with(options)(in, out);
          const std::vector<int> expected = scanned(x, 0, plus, isExclusive, shape, along);
          CHECK(out.read() == expected);
          auto own = streamOf(device, x, shape);
          scans::prefix.with(options)(own, own);
          CHECK(own.read() == expected);
          if (!isNative && shape.rank() > 2) continue;  // another fold in the same programs
          scans::smallest.with(options)(in, out);
          const auto least = [](int a, int b) { return std::min(a, b); };
          CHECK(out.read() == scanned(x, std::numeric_limits<int>::max(), least, isExclusive, shape, along));
        }
      }
    }
  });
}

TEST_CASE("a scan has several accumulators, each in place of an input") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> x = numbers(70001, 1), y = numbers(70001, 2);
    const auto most = [](int a, int b) { return std::max(a, b); };
    constexpr int least = std::numeric_limits<int>::min();
    for (const bool isExclusive : {false, true}) {
      const auto scan =
          scans::sumAndMost.with({.scan = isExclusive ? sk::Scan::Exclusive : sk::Scan::Inclusive});
      auto a = streamOf(device, x), b = streamOf(device, y);
      scan(a, b, b, a);  // crosswise
      CHECK(b.read() == scanned(x, 0, plus, isExclusive));
      CHECK(a.read() == scanned(y, least, most, isExclusive));
    }
  });
}

TEST_CASE("structs are combined by an overload") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> x = numbers(40001);
    for (const int along : {-1, 0}) {
      auto out = device.stream<scans::Run>({40001});
      along < 0 ? scans::runs(streamOf(device, x), out)
                : scans::runs.with({.along = 0})(streamOf(device, x), out);
      const std::vector<scans::Run> got = out.read();
      int total = 0, most = std::numeric_limits<int>::min();
      bool isRight = true;
      for (std::size_t i = 0; i < x.size(); ++i) {
        total += x[i];
        most = std::max(most, x[i]);
        isRight = isRight && got[i].count == static_cast<int>(i) + 1 && got[i].total == total &&
                  got[i].most == most;
      }
      CHECK(isRight);
    }
  });
}

TEST_CASE("elements are folded in order") {
  onEveryTarget([](sk::Device& device) {
    std::mt19937 random(5);
    const auto isSame = [](const std::vector<scans::Map>& a, const std::vector<scans::Map>& b) {
      return std::ranges::equal(a, b, [](auto p, auto q) { return p.a == q.a && p.b == q.b; });
    };
    const auto after = [](scans::Map r, scans::Map x) { return scans::Map{r.a * x.a, r.b * x.a + x.b}; };
    for (const sk::Shape& shape : {sk::Shape{1, 70001}, sk::Shape{300, 301}}) {
      std::vector<scans::Map> x(static_cast<std::size_t>(shape.size()));
      for (scans::Map& map : x)
        map = {static_cast<std::uint32_t>(random()) | 1U, static_cast<std::uint32_t>(random())};
      const auto in = streamOf(device, x, shape);
      auto out = device.stream<scans::Map>(shape);
      for (const int along : {-1, 0, 1}) {
        for (const bool isExclusive : {false, true}) {
          sk::CallOptions options{.scan = isExclusive ? sk::Scan::Exclusive : sk::Scan::Inclusive};
          if (along >= 0) options.along = along;
          scans::maps.with(options)(in, out);
          CHECK(isSame(out.read(), scanned(x, scans::Map{1, 0}, after, isExclusive, shape, along)));
        }
      }
    }
  });
}

TEST_CASE("without an identity, a scan starts from the first element") {
  onEveryTarget([](sk::Device& device) {
    std::vector<scans::Hit> x;
    for (const int i : numbers(200 * 200))
      x.push_back({static_cast<float>(i * i + 7), static_cast<int>(x.size())});
    const auto in = streamOf(device, x, {200, 200});
    auto out = device.stream<scans::Hit>({200, 200});
    for (const int along : {-1, 0, 1}) {
      sk::CallOptions options;
      if (along >= 0) options.along = along;
      scans::nearest.with(options)(in, out);
      const auto nearer = [](scans::Hit h, scans::Hit v) { return v.t < h.t ? v : h; };
      constexpr scans::Hit farthest{1e30F, -1};
      CHECK(std::ranges::equal(out.read(), scanned(x, farthest, nearer, false, {200, 200}, along),
                               [](scans::Hit a, scans::Hit b) { return a.t == b.t && a.id == b.id; }));
    }
  });
}

TEST_CASE("a maximum is of the elements so far") {
  onEveryTarget([](sk::Device& device) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    std::vector<float> x;
    for (const int i : numbers(40000)) x.push_back(static_cast<float>(i) - 20);
    x[30000] = inf;
    const auto in = streamOf(device, x);
    auto out = device.stream<float>({40000});
    const auto most = [](float a, float b) { return std::max(a, b); };
    scans::largest(in, out);
    CHECK(out.read() == scanned(x, -inf, most));
    const auto square = streamOf(device, x, {200, 200});
    auto lines = device.stream<float>({200, 200});
    scans::largest.with({.along = 0})(square, lines);
    CHECK(lines.read() == scanned(x, -inf, most, false, {200, 200}, 0));
  });
}

// ---- floats

constexpr double u = 0x1p-24;

/// Multiples of 2^-33 whose sums are exact in 62 bits.
std::vector<float> cancelling(std::size_t count) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> mantissa(1, 2);
  std::uniform_int_distribution<int> exponent(-10, 10);
  std::vector<float> x(count);
  for (float& v : x) v = std::ldexp(mantissa(random), exponent(random)) * (random() % 2 == 0 ? 1.0F : -1.0F);
  return x;
}

/// True if each result is within `relative` of the sum, and `absolute` times the sum of magnitudes, of the exact one.
bool areWithin(const std::vector<float>& got, const std::vector<float>& x, double relative, double absolute) {
  long double sum = 0, magnitude = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sum += x[i];
    magnitude += std::fabs(x[i]);
    if (!(std::fabs(got[i] - sum) <= relative * std::fabs(sum) + absolute * magnitude)) return false;
  }
  return true;
}

TEST_CASE("sums of floats are compensated, plain or exact") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> x = cancelling(100003);
    const auto in = streamOf(device, x);
    auto out = device.stream<float>({100003});
    const double log = std::log2(100003.0) + 1;
    scans::sums(in, out);
    CHECK(areWithin(out.read(), x, u, log * log * u * u));
    scans::sums.with({.accumulate = sk::Accumulate::Compensated})(in, out);
    CHECK(areWithin(out.read(), x, u, log * log * u * u));
    scans::sums.with({.accumulate = sk::Accumulate::Tree})(in, out);
    CHECK(areWithin(out.read(), x, 0, 100 * u));
    CHECK_FALSE(areWithin(out.read(), x, u, log * log * u * u));  // so these numbers need compensation
    scans::sums.with({.accumulate = sk::Accumulate::Exact})(in, out);
    CHECK(areWithin(out.read(), x, u, 0));
    const bool hasDoubles = !device.profile().starts_with("essl");
    scans::sums.with({.precision = hasDoubles ? sk::Precision::Double : sk::Precision::Extended})(in, out);
    CHECK(areWithin(out.read(), x, u, 100 * u * u));
    scans::sums.with(sk::CallOptions{.accumulate = sk::Accumulate::Exact, .scan = sk::Scan::Exclusive})(in,
                                                                                                        out);
    std::vector<float> got = out.read();
    CHECK(got[0] == 0);
    got.erase(got.begin());
    CHECK(areWithin(got, {x.begin(), x.end() - 1}, u, 0));
  });
}

TEST_CASE("exact sums go along each dimension") {
  onEveryTarget([](sk::Device& device) {
    const sk::Shape shape{300, 70};
    const std::vector<float> x = cancelling(static_cast<std::size_t>(shape.size()));
    const auto in = streamOf(device, x, shape);
    auto out = device.stream<float>(shape);
    for (const int along : {0, 1}) {
      for (const bool isExclusive : {false, true}) {
        // large programs: on GL, each direction and each kind once
        if (isExclusive != (along == 1) && &device != &run_tests::device("native")) continue;
        scans::sums.with(sk::CallOptions{.accumulate = sk::Accumulate::Exact,
                                         .scan = isExclusive ? sk::Scan::Exclusive : sk::Scan::Inclusive,
                                         .along = along})(in, out);
        const std::vector<double> exact =
            scanned(x, 0.0, [](double s, float v) { return s + double{v}; }, isExclusive, shape, along);
        CHECK(out.read() ==
              std::vector<float>(exact.begin(), exact.end()));  // doubles add few of these exactly
      }
    }
  });
}

TEST_CASE("halves are scanned in half precision") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<float> ones(1000, 1.0F);
    auto out = device.stream<float>({1000});
    scans::sums.with({.precision = sk::Precision::Half})(streamOf(device, ones), out);
    CHECK(out.read() == scanned(ones, 0.0F, plus));
    scans::sums.with({.precision = sk::Precision::Half})(streamOf<float>(device, {2048, 1, 1}),
                                                         out.domain({0}, {3}));
    CHECK(out.domain({0}, {3}).read() == std::vector<float>{2048, 2048, 2048});
  });
}

TEST_CASE("infinities and NaN go on") {
  onEveryTarget([](sk::Device& device) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    std::vector<float> x(50000, 1.0F);
    x[20000] = inf;
    x[40000] = -inf;
    for (const sk::Accumulate how :
         {sk::Accumulate::Tree, sk::Accumulate::Compensated, sk::Accumulate::Exact}) {
      auto out = device.stream<float>({50000});
      scans::sums.with({.accumulate = how})(streamOf(device, x), out);
      const std::vector<float> got = out.read();
      CHECK(got[19999] == 20000);
      CHECK(std::all_of(got.begin() + 20000, got.begin() + 40000, [](float v) { return v == inf; }));
      CHECK(std::all_of(got.begin() + 40000, got.end(), [](float v) { return std::isnan(v); }));
    }
  });
}

// ---- what is read and written

TEST_CASE("views are scanned, also to places that overlap them") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> x = numbers(300 * 300);
    std::vector<int> part;
    for (std::size_t row = 10; row < 210; ++row)
      part.insert(part.end(), x.begin() + static_cast<std::ptrdiff_t>(row * 300 + 20),
                  x.begin() + static_cast<std::ptrdiff_t>(row * 300 + 270));
    for (const int along : {-1, 0, 1}) {
      for (const sk::Index& to :
           {sk::Index{10, 20}, sk::Index{11, 21}, sk::Index{9, 20}, sk::Index{10, 19}}) {
        auto all = streamOf(device, x, {300, 300});
        const auto out = all.domain(to, {to[0] + 200, to[1] + 250});
        sk::CallOptions options;
        if (along >= 0) options.along = along;
        scans::prefix.with(options)(all.domain({10, 20}, {210, 270}), out);
        CHECK(out.read() == scanned(part, 0, plus, false, {200, 250}, along));
        CHECK(all.read()[0] == x[0]);
      }
    }
    auto line = streamOf(device, x);
    scans::prefix(line.domain({0}, {89999}), line.domain({1}, {90000}));  // shifted
    CHECK(line.domain({1}, {90000}).read() == scanned(std::vector<int>(x.begin(), x.end() - 1), 0, plus));
  });
}

TEST_CASE("inputs of other shapes, gathers, iterators and indices can be scanned") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> x = numbers(200 * 210), row = numbers(210, 2);
    std::vector<int> products(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) products[i] = x[i] * row[i % 210];
    const auto in = streamOf(device, x, {200, 210});
    auto out = device.stream<int>({200, 210});
    for (const int along : {-1, 0, 1}) {
      sk::CallOptions options;
      if (along >= 0) options.along = along;
      scans::products.with(options)(in, streamOf(device, row, {1, 210}), out);
      CHECK(out.read() == scanned(products, 0, plus, false, {200, 210}, along));
      auto places = device.stream<scans::Place>({200, 210});
      scans::places.with(options)(in, places);
      std::vector<int> weighted(x.size()), got;
      for (std::size_t i = 0; i < x.size(); ++i) weighted[i] = x[i] * static_cast<int>(i % 210);
      for (const scans::Place& place : places.read()) got.push_back(place.sum);
      CHECK(got == scanned(weighted, 0, plus, false, {200, 210}, along));
    }
    const std::size_t n = x.size();
    const auto flat = streamOf(device, x);
    std::vector<int> terms(n);
    for (std::size_t i = 0; i < n; ++i) terms[i] = x[i] * x[std::min(i + 1, n - 1)] - x[i == 0 ? 0 : i - 1];
    auto sums = device.stream<scans::Place>({static_cast<std::int64_t>(n)});
    scans::around(flat, flat, sums);
    std::vector<int> got;
    for (const scans::Place& place : sums.read()) got.push_back(place.sum);
    CHECK(got == scanned(terms, 0, plus));
    auto ramp = device.stream<int>({static_cast<std::int64_t>(n)});
    for (std::size_t i = 0; i < n; ++i) terms[i] = static_cast<int>(i) * 3 + x[i];
    scans::ramp(sk::iter(0, static_cast<int>(n)), streamOf(device, x), 3, ramp);
    CHECK(ramp.read() == scanned(terms, 0, plus));
  });
}

TEST_CASE("wrong calls of scans say why") {
  onEveryTarget([](sk::Device& device) {
    auto x = device.stream<int>({10}), y = device.stream<int>({9});
    auto h = device.stream<scans::Hit>({10});
    x.fill(1);
    h.fill({1, 1});
    CHECK_THAT(errorOf([&] { scans::prefix(x, y); }),
               Contains("'x' has shape {10}, and the output 's' has {9}"));
    CHECK_THAT(errorOf([&] { scans::nearest.with(exclusive)(h, h); }), Contains("'h' declares none"));
    CHECK_THAT(errorOf([&] { scans::prefix.with({.along = 1})(x, x); }),
               Contains("no dimension 1; along is 0 to 0"));
    CHECK_THAT(errorOf([&] { scans::prefix.with({.along = -1})(x, x); }), Contains("no dimension -1"));
    CHECK_THAT(errorOf([&] { scans::twice.with(exclusive)(x, x); }), Contains("it is not a scan"));
    CHECK_THAT(errorOf([&] { scans::twice.with({.along = 0})(x, x); }), Contains("it is not a scan"));
    CHECK_THAT(errorOf([&] { (void)scans::total.with(exclusive)(x); }), Contains("it is not a scan"));
    CHECK_THAT(errorOf([&] { scans::sumAndMost(x, x, x, x); }), Contains("overlap"));
  });
}

TEST_CASE("the bits of a scan do not depend on the number of threads") {
  sk::Device& native = device("native");
  const std::vector<float> x = cancelling(1 << 18);
  for (const sk::Shape& shape : {sk::Shape{1 << 9, 1 << 9}, sk::Shape{1 << 16, 4}, sk::Shape{2, 1 << 17}}) {
    const auto in = streamOf(native, x, shape);
    for (const sk::Accumulate how : {sk::Accumulate::Tree, sk::Accumulate::Compensated}) {
      for (const int along : {-1, 0, 1}) {
        sk::CallOptions options{.accumulate = how};
        if (along >= 0) options.along = along;
        auto some = native.stream<float>(shape), one = native.stream<float>(shape);
        scans::sums.with(options)(in, some);
        // a loop inside another one has a single thread
        sk::native::inParallel(2, 1 << 20, sk::native::Deal::Evenly, [&](sk::native::Range range) {
          if (range.begin == 0) scans::sums.with(options)(in, one);
        });
        const std::vector<float> a = some.read(), b = one.read();
        CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
      }
    }
  }
}

// Pieces of columns are combined in the order that their leaves have in one piece. 16 elements are a leaf, so that each length
// ends with another number of leaves.
TEST_CASE("the bits of sums of few columns do not depend on the number of threads") {
  sk::Device& native = device("native");
  for (const sk::Shape& shape :
       {sk::Shape{20000, 9}, sk::Shape{8191, 24}, sk::Shape{5003, 60}, sk::Shape{4097, 63}}) {
    INFO(sk::toString(shape));
    const auto in = streamOf(native, cancelling(static_cast<std::size_t>(shape.size())), shape);
    for (const sk::Accumulate how : {sk::Accumulate::Tree, sk::Accumulate::Compensated}) {
      for (const std::int64_t width : {shape[1], shape[1] / 3}) {
        auto some = native.stream<float>({1, width}), one = native.stream<float>({1, width});
        scans::totalOfFloats.with({.accumulate = how})(in, some);
        // a loop inside another one has a single thread
        sk::native::inParallel(2, 1 << 20, sk::native::Deal::Evenly, [&](sk::native::Range range) {
          if (range.begin == 0) scans::totalOfFloats.with({.accumulate = how})(in, one);
        });
        const std::vector<float> a = some.read(), b = one.read();
        CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
      }
    }
  }
}

TEST_CASE("long lines across short rows are scanned and folded, with or without the element itself") {
  sk::Device& native = device("native");
  for (const int width : {2, 3, 8, 9}) {
    INFO("width " << width);
    const sk::Shape shape{20000 / width, width};
    const std::vector<int> x = numbers(static_cast<std::size_t>(shape.size())), y = numbers(x.size(), 2);
    const auto in = streamOf(native, x, shape), other = streamOf(native, y, shape);
    const auto larger = [&] {
      auto all = native.stream<int>({shape[0], 2 * width});
      sk::stride(all, {1, 2}).write(x);
      return all;
    }();
    auto out = native.stream<int>(shape);
    const auto times = [](int s, int a) { return s + a; };
    std::vector<int> products(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) products[i] = x[i] * y[i];
    for (const bool isExclusive : {false, true}) {
      const sk::CallOptions options{.scan = isExclusive ? sk::Scan::Exclusive : sk::Scan::Inclusive,
                                    .along = 0};
      scans::products.with(options)(in, other, out);
      CHECK(out.read() == scanned(products, 0, times, isExclusive, shape, 0));
      scans::prefix.with(options)(sk::stride(larger, {1, 2}), out);
      CHECK(out.read() == scanned(x, 0, times, isExclusive, shape, 0));
    }
    auto totals = native.stream<int>({1, width});
    scans::total(in, totals);
    std::vector<int> expected(static_cast<std::size_t>(width));
    for (std::size_t i = 0; i < x.size(); ++i) expected[i % expected.size()] += x[i];
    CHECK(totals.read() == expected);
  }
}

}  // namespace
}  // namespace run_tests
