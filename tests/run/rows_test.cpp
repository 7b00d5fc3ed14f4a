// SPDX-License-Identifier: MIT
//
// Promises: a reduce of inputs in rows has one result for each row, in order, whatever the lengths of the rows are, and a
// scan starts anew in each row; starts that cannot be rows are refused; and results have the same bits for any number of
// threads.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "rows.sk.hpp"
#include "rows_support.hpp"
#include "sk/native/parallel.hpp"
#include "sk/sk.hpp"
#include "support/devices.hpp"

namespace run_tests {
namespace {

using Catch::Matchers::Contains;

constexpr sk::CallOptions exclusive{.scan = sk::Scan::Exclusive};

/// Folds each row by a plain loop.
template <class T, class X, class Fold>
std::vector<T> foldedRows(const Starts& starts, const std::vector<X>& x, const T& identity,
                          const Fold& fold) {
  std::vector<T> results;
  for (std::size_t row = 0; row < rowsIn(starts); ++row) {
    T total = identity;
    for (std::int32_t i = starts[row]; i < starts[row + 1]; ++i)
      total = fold(total, x[static_cast<std::size_t>(i)]);
    results.push_back(total);
  }
  return results;
}

template <class T, class X, class Fold>
std::vector<T> scannedRows(const Starts& starts, const std::vector<X>& x, const T& identity, const Fold& fold,
                           bool isExclusive = false) {
  std::vector<T> results;
  for (std::size_t row = 0; row < rowsIn(starts); ++row) {
    T total = identity;
    for (std::int32_t i = starts[row]; i < starts[row + 1]; ++i) {
      const T before = total;
      total = fold(total, x[static_cast<std::size_t>(i)]);
      results.push_back(isExclusive ? before : total);
    }
  }
  return results;
}

const auto plus = [](auto a, auto b) { return a + b; };

/// Lengths of rows of every kind.
std::vector<std::vector<int>> manyLengths() {
  std::vector<int> mixed = randomLengths(400, 40);
  mixed[5] = 3000;
  mixed[6] = 0;
  mixed[7] = 2048;
  mixed[300] = 70001;
  std::vector<int> sparse(3000, 0);
  sparse[1500] = 33;
  sparse[2999] = 1;
  return {{1},
          {0},
          {33},
          {0, 0, 5},
          {100003},
          {1024 * 32 + 1, 0, 31, 32, 33},
          std::vector<int>(20000, 0),
          mixed,
          sparse,
          randomLengths(5000, 24)};
}

TEST_CASE("each row is folded to an element, whatever its length is") {
  onEveryTarget([](sk::Device& device) {
    for (const std::vector<int>& lengths : manyLengths()) {
      const Starts starts = startsOf(lengths);
      INFO(rowsIn(starts) << " rows, " << starts.back() << " elements");
      const std::vector<int> x = numbers(sizeOf(starts));
      const sk::Rows rows(streamOf(device, starts));  // which does not need the stream any more
      CHECK(rows.count() == static_cast<std::int64_t>(lengths.size()));
      CHECK(rows.end() == starts.back());
      const auto in = streamOf(device, x);
      auto out = streamOf(device, std::vector<int>(lengths.size(), 7));
      rows::total(rows(in), out);
      CHECK(out.read() == foldedRows(starts, x, 0, plus));
    }
  });
}

TEST_CASE("without rows there is nothing to do") {
  onEveryTarget([](sk::Device& device) {
    const sk::Rows rows(streamOf(device, Starts{3}));
    auto x = streamOf(device, numbers(5));
    auto none = device.stream<int>({0});
    rows::total(rows(x), none);
    CHECK(none.read().empty());
    CHECK(rows.count() == 0);
    const sk::Rows empty(streamOf(device, Starts(200001)));  // of a stream without elements
    auto nothing = device.stream<int>({0});
    auto out = streamOf(device, std::vector<int>(200000, 5));
    rows::total(empty(nothing), out);
    CHECK(out.read() == std::vector<int>(200000));
    rows::prefix(empty(nothing), nothing);
  });
}

TEST_CASE("a sparse matrix times a vector") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf(randomLengths(3000, 70, 3));
    std::mt19937 random(4);
    std::vector<float> values, x;
    std::vector<int> columns;
    for (std::size_t i = 0; i < sizeOf(starts); ++i) {
      values.push_back(static_cast<float>(random() % 2001) / 1000 - 1);
      columns.push_back(static_cast<int>(random() % 1000));
    }
    for (int i = 0; i < 1000; ++i) x.push_back(static_cast<float>(random() % 2001) / 1000 - 1);
    const sk::Rows rows(streamOf(device, starts));
    const auto a = streamOf(device, values), vector = streamOf(device, x);
    const auto column = streamOf(device, columns);
    auto y = device.stream<float>({3000});
    for (const sk::Accumulate how :
         {sk::Accumulate::Default, sk::Accumulate::Tree, sk::Accumulate::Compensated, sk::Accumulate::Exact,
          sk::Accumulate::Extended}) {
      INFO("accumulate " << static_cast<int>(how));
      rows::product.with({.accumulate = how})(rows(a), rows(column), vector, y);
      const std::vector<float> got = y.read();
      const double bound = how == sk::Accumulate::Tree ? 70 * 0x1p-24 : 0x1p-24;
      std::size_t wrong = 0;
      for (std::size_t row = 0; row < rowsIn(starts); ++row) {
        double sum = 0, magnitude = 0;
        for (auto i = static_cast<std::size_t>(starts[row]); i < static_cast<std::size_t>(starts[row + 1]);
             ++i) {
          const double term = double{values[i]} * x[static_cast<std::size_t>(columns[i])];
          sum += term;
          magnitude += std::fabs(term);
        }
        // on GL, products are rounded before sums are compensated
        const double allowed = how == sk::Accumulate::Exact ? bound * std::fabs(sum) + 0x1p-60
                                                            : bound * (std::fabs(sum) + magnitude);
        wrong += std::fabs(got[row] - sum) <= allowed ? 0 : 1;
      }
      CHECK(wrong == 0);
    }
  });
}

TEST_CASE("the elements of a row are folded in order") {
  onEveryTarget([](sk::Device& device) {
    std::mt19937 random(5);
    const Starts starts = startsOf({0, 1, 40, 70000, 3, 33, 0, 2000});
    std::vector<rows::Map> x(sizeOf(starts));
    for (rows::Map& map : x)
      map = {static_cast<std::uint32_t>(random()) | 1U, static_cast<std::uint32_t>(random())};
    const auto after = [](rows::Map r, rows::Map v) { return rows::Map{r.a * v.a, r.b * v.a + v.b}; };
    const auto isSame = [](const std::vector<rows::Map>& a, const std::vector<rows::Map>& b) {
      return std::ranges::equal(a, b, [](auto p, auto q) { return p.a == q.a && p.b == q.b; });
    };
    const sk::Rows rows(streamOf(device, starts));
    const auto in = streamOf(device, x);
    auto out = device.stream<rows::Map>({8});
    rows::maps(rows(in), out);
    CHECK(isSame(out.read(), foldedRows(starts, x, rows::Map{1, 0}, after)));
    auto each = device.stream<rows::Map>({static_cast<std::int64_t>(x.size())});
    for (const bool isExclusive : {false, true}) {
      rows::compose.with({.scan = isExclusive ? sk::Scan::Exclusive : sk::Scan::Inclusive})(rows(in), each);
      CHECK(isSame(each.read(), scannedRows(starts, x, rows::Map{1, 0}, after, isExclusive)));
    }
  });
}

TEST_CASE("rows have several accumulators, structs, vectors, bools and doubles") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf(randomLengths(700, 90, 9));
    const std::size_t n = sizeOf(starts);
    const std::vector<int> x = numbers(n), y = numbers(n, 2);
    const sk::Rows rows(streamOf(device, starts));
    auto s = device.stream<int>({700}), m = device.stream<int>({700});
    rows::sumAndMost(rows(streamOf(device, x)), rows(streamOf(device, y)), s, m);
    CHECK(s.read() == foldedRows(starts, x, 0, plus));
    const auto most = [](int a, int b) { return std::max(a, b); };
    CHECK(m.read() == foldedRows(starts, y, std::numeric_limits<int>::min(), most));

    auto places = device.stream<rows::Counts>({700});
    rows::counts(rows(streamOf(device, std::vector<float>(n, 1))), places);
    const std::vector<rows::Counts> counts = places.read();
    bool isRight = true;
    for (std::size_t row = 0; row < 700; ++row) {  // the index is that in the stream
      const int length = starts[row + 1] - starts[row];
      isRight = isRight && counts[row].count == length &&
                counts[row].last == (length == 0 ? -1 : starts[row + 1] - 1);
    }
    CHECK(isRight);

    std::vector<sk::float3> v;
    std::vector<std::uint8_t> w;
    std::vector<bool> b;
    std::vector<double> d;
    for (const int i : x) {
      v.push_back({static_cast<float>(i), 1, static_cast<float>(-i)});
      w.push_back(static_cast<std::uint8_t>(i + 9));
      b.push_back(i == 9);
      d.push_back(i);
    }
    auto vectors = device.stream<sk::float3>({700});
    rows::vectors(rows(streamOf(device, v)), rows(streamOf(device, w)), vectors);
    std::vector<float> got;
    for (const sk::float3& one : vectors.read()) got.push_back(one.z);
    std::vector<float> terms;
    for (const int i : x) terms.push_back(static_cast<float>(-i * (i + 9)));
    CHECK(got == foldedRows(starts, terms, 0.0F, plus));
    auto bools = device.stream<bool>({700}), in = device.stream<bool>({static_cast<std::int64_t>(n)});
    in.write(b);
    rows::either(rows(in), bools);
    std::vector<int> isNine(n);
    for (std::size_t i = 0; i < n; ++i) isNine[i] = x[i] == 9 ? 1 : 0;
    const std::vector<int> any = foldedRows(starts, isNine, 0, most);
    const auto anyGot = bools.read();
    CHECK(std::ranges::equal(anyGot, any, [](bool a, int c) { return a == (c == 1); }));
    auto doubles = device.stream<double>({700});
    rows::reals(rows(streamOf(device, d)), doubles);
    CHECK(doubles.read() == foldedRows(starts, d, 0.0, plus));
  });
}

TEST_CASE("neighbours, iterators and uniforms are those of the stream") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf({5, 0, 100, 1, 40});
    const std::size_t n = sizeOf(starts);
    const std::vector<int> x = numbers(n);
    std::vector<int> terms(n);
    for (std::size_t i = 0; i < n; ++i) terms[i] = x[i] * x[std::min(i + 1, n - 1)] + static_cast<int>(i);
    const auto in = streamOf(device, x);
    const sk::Rows rows(streamOf(device, starts));
    auto out = device.stream<int>({5});
    rows::near(rows(in), in, sk::iter(0, static_cast<int>(n)), out);
    CHECK(out.read() == foldedRows(starts, terms, 0, plus));
    const auto floats = streamOf(device, std::vector<float>(x.begin(), x.end()));
    auto means = device.stream<float>({5});
    const auto scale = device.scalar<float>(2);
    rows::mean(rows(floats), 2.0F, means);
    std::vector<float> expected;
    for (const int total : foldedRows(starts, x, 0, plus)) expected.push_back(2 * static_cast<float>(total));
    CHECK(means.read() == expected);
    means.fill(0);
    rows::mean(rows(floats), scale, means);
    CHECK(means.read() == expected);
  });
}

TEST_CASE("views are in rows, and results may be views") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf(randomLengths(500, 40, 11));
    const std::vector<int> all = numbers(sizeOf(starts) + 30);
    const auto stream = streamOf(device, all);
    const auto firstStarts = streamOf(device, starts);
    for (const int offset : {0, 1, 3, 4, 7}) {
      const std::vector<int> x(all.begin() + offset, all.end());
      const auto view = stream.domain({offset}, {static_cast<std::int64_t>(all.size())});
      const sk::Rows rows(firstStarts.domain({1}, {501}));  // the first row left out
      const Starts used(starts.begin() + 1, starts.end());
      auto out = streamOf(device, std::vector<int>(600, 7));
      rows::total(rows(view), out.domain({offset}, {offset + 499}));
      std::vector<int> expected(600, 7);
      std::ranges::copy(foldedRows(used, x, 0, plus), expected.begin() + offset);
      CHECK(out.read() == expected);
      const sk::Rows whole(firstStarts);
      const auto part = stream.domain({offset}, {offset + starts.back()});
      auto scanned = streamOf(device, all);
      rows::prefix(whole(part), scanned.domain({30 - offset}, {30 - offset + starts.back()}));
      CHECK(scanned.domain({30 - offset}, {30 - offset + starts.back()}).read() ==
            scannedRows(starts, x, 0, plus));
      CHECK(scanned.domain({0}, {30 - offset}).read() ==
            std::vector<int>(all.begin(), all.begin() + 30 - offset));
    }
  });
}

TEST_CASE("the results of many short rows may be a part of a stream that is new") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf(randomLengths(1545, 1));
    const sk::Rows rows(streamOf(device, starts));
    auto out = device.stream<int>({1553});
    out.fill(7);
    const auto x = streamOf(device, numbers(sizeOf(starts)));
    rows::total(rows(x), out.domain({1}, {1546}));
    CHECK(out.domain({1}, {1546}).read() == foldedRows(starts, x.read(), 0, plus));
    CHECK(out.domain({1546}, {1553}).read() == std::vector<int>(7, 7));
  });
}

TEST_CASE("a row is folded into the stream that it is in, and a result may be read") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> x = numbers(64);
    auto stream = streamOf(device, x);
    const Starts starts = startsOf({60, 0, 4});
    const sk::Rows rows(streamOf(device, starts));
    rows::total(rows(stream), stream.domain({10}, {13}));
    std::vector<int> expected = x;
    std::ranges::copy(foldedRows(starts, x, 0, plus), expected.begin() + 10);
    CHECK(stream.read() == expected);
    rows::prefix(rows(stream), stream);  // in place
    CHECK(stream.read() == scannedRows(starts, expected, 0, plus));
  });
}

TEST_CASE("rows lie in any layout of textures") {
  onSomeLayouts([](sk::Device& device) {
    const Starts starts = startsOf(randomLengths(300, 70, 12));
    const std::vector<int> x = numbers(sizeOf(starts) + 1);
    std::vector<sk::float3> vectors;
    for (const int i : x) vectors.push_back({0, static_cast<float>(i), 0});
    const auto all = streamOf(device, x);
    const auto in = all.domain({1}, {static_cast<std::int64_t>(x.size())});
    const auto wide = streamOf(device, vectors);
    const sk::Rows rows(streamOf(device, starts));
    const std::vector<int> own(x.begin() + 1, x.end());
    auto out = device.stream<int>({300}), each = device.stream<int>({starts.back()});
    rows::total(rows(in), out);
    CHECK(out.read() == foldedRows(starts, own, 0, plus));
    rows::prefix(rows(in), each);
    CHECK(each.read() == scannedRows(starts, own, 0, plus));
    auto sums = device.stream<sk::float3>({300});
    const auto weights = streamOf(device, std::vector<std::uint8_t>(x.size(), 1));
    rows::vectors(rows(wide), rows(weights), sums);
    std::vector<int> got;
    for (const sk::float3& sum : sums.read()) got.push_back(static_cast<int>(sum.y));
    CHECK(got == foldedRows(starts, x, 0, plus));
  });
}

TEST_CASE("each row is scanned on its own") {
  onEveryTarget([](sk::Device& device) {
    for (const std::vector<int>& lengths : manyLengths()) {
      const Starts starts = startsOf(lengths);
      INFO(rowsIn(starts) << " rows, " << starts.back() << " elements");
      const std::vector<int> x = numbers(sizeOf(starts));
      const sk::Rows rows(streamOf(device, starts));
      const auto in = streamOf(device, x);
      auto out = device.stream<int>({starts.back()});
      rows::prefix(rows(in), out);
      CHECK(out.read() == scannedRows(starts, x, 0, plus));
      rows::prefix.with(exclusive)(rows(in), out);
      CHECK(out.read() == scannedRows(starts, x, 0, plus, true));
    }
  });
}

TEST_CASE("without an identity, a row starts from its first element") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf({1, 50, 3000, 2});
    std::vector<rows::Hit> hits;
    std::vector<float> x;
    for (const int i : numbers(sizeOf(starts))) {
      x.push_back(static_cast<float>(i * i + 7));
      hits.push_back({x.back(), static_cast<int>(hits.size())});
    }
    const sk::Rows rows(streamOf(device, starts));
    auto best = device.stream<rows::Hit>({4});
    rows::nearest(rows(streamOf(device, hits)), best);
    const auto nearer = [](rows::Hit h, rows::Hit v) { return v.t < h.t ? v : h; };
    CHECK(std::ranges::equal(best.read(), foldedRows(starts, hits, rows::Hit{1e30F, -1}, nearer),
                             [](rows::Hit a, rows::Hit b) { return a.t == b.t && a.id == b.id; }));
    auto largest = device.stream<float>({4});
    rows::largest(rows(streamOf(device, x)), largest);
    const auto most = [](float a, float b) { return std::max(a, b); };
    CHECK(largest.read() == foldedRows(starts, x, -1.0F, most));
    const Starts gaps = startsOf({0, 50, 0, 3003, 0});
    const sk::Rows some(streamOf(device, gaps));
    auto least = device.stream<float>({starts.back()});
    rows::smallest(some(streamOf(device, x)), least);  // rows without elements have no results
    CHECK(least.read() == scannedRows(gaps, x, 1e30F, [](float a, float b) { return std::min(a, b); }));
    auto five = device.stream<rows::Hit>({5});
    CHECK_THAT(errorOf([&] { rows::nearest(some(streamOf(device, hits)), five); }),
               Contains("row 0 has no element to fold, and 'best' declares no identity"));
  });
}

// ---- floats

std::vector<float> cancelling(std::size_t count) {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> mantissa(1, 2);
  std::uniform_int_distribution<int> exponent(-10, 10);
  std::vector<float> x(count);
  for (float& v : x) v = std::ldexp(mantissa(random), exponent(random)) * (random() % 2 == 0 ? 1.0F : -1.0F);
  return x;
}

TEST_CASE("sums of floats in rows are compensated, plain, exact or in other precisions") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf({3, 0, 40, 33000, 33000, 900});
    const std::vector<float> x = cancelling(sizeOf(starts));
    constexpr double u = 0x1p-24;
    const sk::Rows rows(streamOf(device, starts));
    const auto in = streamOf(device, x);
    auto out = device.stream<float>({6});
    auto each = device.stream<float>({starts.back()});
    const auto isWithin = [&](double relative, double absolute) {
      const std::vector<float> got = out.read(), gotEach = each.read();
      for (std::size_t row = 0; row < rowsIn(starts); ++row) {
        long double sum = 0, magnitude = 0;
        const auto isNear = [&](float value) {
          return std::fabs(value - sum) <= relative * std::fabs(sum) + absolute * magnitude;
        };
        for (auto i = static_cast<std::size_t>(starts[row]); i < static_cast<std::size_t>(starts[row + 1]);
             ++i) {
          sum += x[i];
          magnitude += std::fabs(x[i]);
          if (!isNear(gotEach[i])) return false;
        }
        if (!isNear(got[row])) return false;
      }
      return true;
    };
    const auto call = [&](const sk::CallOptions& options) {
      rows::sum.with(options)(rows(in), out);
      rows::sums.with(options)(rows(in), each);
    };
    const double log = std::log2(33000.0) + 1;
    call({});
    CHECK(isWithin(u, log * log * u * u));
    call({.accumulate = sk::Accumulate::Compensated});
    CHECK(isWithin(u, log * log * u * u));
    call({.accumulate = sk::Accumulate::Tree});
    CHECK(isWithin(0, 100 * u));
    CHECK_FALSE(isWithin(u, log * log * u * u));
    call({.accumulate = sk::Accumulate::Exact});
    CHECK(isWithin(u, 0));
    call({.precision =
              device.profile().starts_with("essl") ? sk::Precision::Extended : sk::Precision::Double});
    CHECK(isWithin(u, 100 * u * u));
    const auto ones = streamOf(device, std::vector<float>(x.size(), 1));
    rows::sum.with({.precision = sk::Precision::Half})(rows(ones), out);
    const std::vector<float> halves = out.read();
    for (const std::size_t row : {3, 4})
      CHECK(std::fabs(halves[row] - 33000) <= 32);  // as far apart as halves of this size
    CHECK(std::vector{halves[0], halves[1], halves[2], halves[5]} == std::vector<float>{3, 0, 40, 900});
  });
}

TEST_CASE("infinities and NaN stay in their rows") {
  onEveryTarget([](sk::Device& device) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    std::vector<float> x(300, 1.0F);
    x[10] = inf;
    x[120] = inf;
    x[180] = -inf;
    const sk::Rows rows(streamOf(device, startsOf({100, 100, 100})));
    for (const sk::Accumulate how :
         {sk::Accumulate::Tree, sk::Accumulate::Compensated, sk::Accumulate::Exact}) {
      auto out = device.stream<float>({3});
      rows::sum.with({.accumulate = how})(rows(streamOf(device, x)), out);
      const std::vector<float> got = out.read();
      CHECK(got[0] == inf);
      CHECK(std::isnan(got[1]));
      CHECK(got[2] == 100);
    }
  });
}

TEST_CASE("streams with other storages are in rows") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf(randomLengths(100, 60, 2));
    const std::vector<int> x = numbers(sizeOf(starts));
    const sk::Rows rows(streamOf(device, starts));
    for (const sk::Storage storage : {sk::Storage::Half, sk::Storage::Double}) {
      auto in = device.stream<float>({starts.back()}, storage), out = device.stream<float>({100}, storage);
      in.write(std::vector<float>(x.begin(), x.end()));
      rows::sum(rows(in), out);
      const std::vector<int> expected = foldedRows(starts, x, 0, plus);
      CHECK(out.read() == std::vector<float>(expected.begin(), expected.end()));
    }
  });
}

// ---- other calls

TEST_CASE("a loop repeats calls in rows, also after the rows are gone") {
  onEveryTarget([](sk::Device& device) {
    const Starts starts = startsOf(randomLengths(50, 70, 2));
    const std::vector<int> x = numbers(sizeOf(starts));
    const auto in = streamOf(device, x);
    auto out = device.stream<int>({50}), each = device.stream<int>({starts.back()});
    std::optional<sk::Rows> rows(std::in_place, streamOf(device, starts));
    sk::Loop loop = device.record([&] {
      rows::total((*rows)(in), out);
      rows::prefix((*rows)(in), each);
    });
    rows.reset();
    out.fill(0);
    loop.repeat(5);
    CHECK(out.read() == foldedRows(starts, x, 0, plus));
    CHECK(each.read() == scannedRows(starts, x, 0, plus));
  });
}

TEST_CASE("later changes of the starts have no effect") {
  onEveryTarget([](sk::Device& device) {
    const std::vector<int> x = numbers(10);
    auto starts = streamOf(device, Starts{0, 4, 10});
    const sk::Rows rows(starts);
    starts.write(Starts{0, 10, 10});
    auto out = device.stream<int>({2});
    rows::total(rows(streamOf(device, x)), out);
    CHECK(out.read() == foldedRows({0, 4, 10}, x, 0, plus));
  });
}

TEST_CASE("rows that cannot be, and wrong calls in rows, say why") {
  onEveryTarget([](sk::Device& device) {
    CHECK_THAT(errorOf([&] { sk::Rows(streamOf(device, Starts{0, 3, 7, 5, 9})); }),
               Contains("row 2 starts at 7, but ends at 5"));
    CHECK_THAT(errorOf([&] { sk::Rows(streamOf(device, Starts{-1, 3})); }), Contains("row 0 starts at -1"));
    CHECK_THAT(errorOf([&] { sk::Rows(device.stream<int>({0})); }), Contains("the starts have shape {0}"));
    CHECK_THAT(errorOf([&] { sk::Rows(device.stream<int>({2, 2})); }),
               Contains("the starts have shape {2, 2}"));
    const sk::Rows rows(streamOf(device, Starts{0, 3, 3, 9})), others(streamOf(device, Starts{0, 3, 3, 9}));
    auto x = streamOf(device, numbers(9)), few = streamOf(device, numbers(8)), y = device.stream<int>({3});
    auto m = device.stream<int>({3}), square = device.stream<int>({3, 3});
    square.fill(0);
    CHECK_THAT(errorOf([&] { rows::total(rows(few), y); }),
               Contains("row 2 ends at 9, but 'x' has 8 elements"));
    CHECK_THAT(errorOf([&] { rows::total(rows(x), few); }),
               Contains("there are 3 rows, but the output 's' has shape {8}; give it shape {3}"));
    CHECK_THAT(errorOf([&] { (void)rows::total(rows(x)); }),
               Contains("give a stream of as many elements for 's'"));
    CHECK_THAT(errorOf([&] { rows::total(rows(square), y); }), Contains("one dimension"));
    CHECK_THAT(errorOf([&] { rows::sumAndMost(rows(x), x, y, m); }),
               Contains("'x' and 'y' are not both in rows"));
    CHECK_THAT(errorOf([&] { rows::sumAndMost(x, rows(x), y, m); }),
               Contains("'x' and 'y' are not both in rows"));
    CHECK_THAT(errorOf([&] { rows::sumAndMost(rows(x), others(x), y, m); }), Contains("in different rows"));
    CHECK_THAT(errorOf([&] { rows::sumAndMost(rows(x), rows(few), y, m); }), Contains("shape"));
    CHECK_THAT(errorOf([&] { rows::twice(rows(x), few); }), Contains("'x' is in rows"));
    CHECK_THAT(errorOf([&] { rows::prefix(rows(x), y); }), Contains("there are 9 elements"));
    CHECK_THAT(errorOf([&] { rows::prefix.with({.along = 0})(rows(x), x); }), Contains("without along"));
    auto longer = streamOf(device, numbers(11));
    CHECK_THAT(errorOf([&] { rows::prefix(rows(longer), longer); }),
               Contains("the rows have elements 0 to 9, and 'x' has 11"));
    auto hits = device.stream<rows::Hit>({9});
    hits.fill({1, 1});
    CHECK_THAT(errorOf([&] { rows::first.with(exclusive)(rows(hits), hits); }), Contains("declares none"));
    sk::Rows moved(streamOf(device, Starts{0, 9}));
    const sk::Rows taken = std::move(moved);
    CHECK_THAT(errorOf([&] { rows::total(moved(x), y); }), Contains("moved from"));
    const auto starts = streamOf(device, Starts{0, 9});
    CHECK_THAT(errorOf([&] { (void)device.record([&] { sk::Rows inLoop(starts); }); }), Contains("rows: "));
  });
}

TEST_CASE("rows belong to their device") {
  sk::Device& native = device("native");
  std::optional<sk::Device> other(std::in_place, sk::DeviceOptions{.device = "native"});
  std::optional<sk::Rows> rows(std::in_place, streamOf(*other, Starts{0, 3}));
  auto x = streamOf(native, numbers(3)), y = native.stream<int>({1});
  CHECK_THAT(errorOf([&] { rows::total((*rows)(x), y); }), Contains("another device"));
  other.reset();
  CHECK_THAT(errorOf([&] { rows::total((*rows)(x), y); }), Contains("has ended"));
}

TEST_CASE("the bits of sums in rows do not depend on the number of threads") {
  sk::Device& native = device("native");
  std::vector<int> lengths = randomLengths(20000, 60, 6);
  lengths[100] = 1 << 18;
  lengths[15000] = 5000;
  const Starts starts = startsOf(lengths);
  const std::vector<float> x = cancelling(sizeOf(starts));
  const sk::Rows rows(streamOf(native, starts));
  const auto in = streamOf(native, x);
  for (const sk::Accumulate how : {sk::Accumulate::Tree, sk::Accumulate::Default}) {
    auto some = native.stream<float>({20000}), one = native.stream<float>({20000});
    auto someEach = native.stream<float>({starts.back()}), oneEach = native.stream<float>({starts.back()});
    const auto call = [&](auto& out, auto& each) {
      rows::sum.with({.accumulate = how})(rows(in), out);
      rows::sums.with({.accumulate = how})(rows(in), each);
    };
    call(some, someEach);
    sk::native::inParallel(2, 1 << 20, sk::native::Deal::Evenly, [&](sk::native::Range range) {
      if (range.begin == 0) call(one, oneEach);  // a loop inside another one has a single thread
    });
    const std::vector<float> a = some.read(), b = one.read(), c = someEach.read(), d = oneEach.read();
    CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
    CHECK(std::memcmp(c.data(), d.data(), c.size() * sizeof(float)) == 0);
  }
}

}  // namespace
}  // namespace run_tests
