// SPDX-License-Identifier: MIT
//
// Promises: scans over ranks, along a dimension or over all elements, inclusive or exclusive, give the bits of one device for
// integers and other folds without rounding, in order where it counts. Floats have one more rounding for each rank before.
#include <cmath>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "ranks.hpp"
#include "scans.sk.hpp"
#include "sk/mpi.hpp"
#include "sk/sk.hpp"

namespace {

const sk::Shape shape{12, 14};

int number(const sk::Index& i) { return static_cast<int>((i[0] * 37 + i[1] * 11) % 23) - 9; }

template <class T>
std::vector<T> valuesOf() {
  std::vector<T> values;
  for (std::int64_t k = 0; k < shape.size(); ++k)
    values.push_back(static_cast<T>(number(sk::Index{k / 14, k % 14})));
  return values;
}

/// Calls visit(domain, options) for every split of the ranks, and every kind of scan that is possible with it.
template <class Visit>
void forEachScan(Visit&& visit) {
  for (int rows = 1; rows <= ranksOfWorld(); ++rows) {
    if (ranksOfWorld() % rows != 0) continue;
    sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .split = {rows, ranksOfWorld() / rows}});
    for (const sk::Scan kind : {sk::Scan::Inclusive, sk::Scan::Exclusive}) {
      for (const std::optional<int> along : {std::optional<int>(), std::optional(0), std::optional(1)}) {
        if (!along && domain.split()[1] > 1) continue;
        INFO("split " << sk::toString(domain.split()) << ", along " << along.value_or(-1) << ", exclusive "
                      << (kind == sk::Scan::Exclusive));
        visit(domain, sk::CallOptions{.scan = kind, .along = along});
      }
    }
  }
}

template <class T>
std::vector<T> wholeOf(const sk::DomainStream<T>& stream) {
  return everywhere(stream.gather());
}

TEST_CASE("integer scans have the bits of one device") {
  sk::Device device("native");
  auto x = device.stream<int>(shape), s = device.stream<int>(shape), most = device.stream<int>(shape);
  x.write(valuesOf<int>());
  forEachScan([&](sk::Domain& domain, const sk::CallOptions& options) {
    auto u = domain.stream<int>(), v = domain.stream<int>(), w = domain.stream<int>();
    u.fill(number);
    running.with(options)(x, s);
    running.with(options)(u, v);
    CHECK(wholeOf(v) == s.read());
    highest.with(options)(x, s);
    highest.with(options)(u, v);
    CHECK(wholeOf(v) == s.read());
    weighed.with(options)(x, x, 3, s);
    weighed.with(options)(u, u, 3, v);
    CHECK(wholeOf(v) == s.read());
    both.with(options)(x, s, most);
    both.with(options)(u, v, w);
    CHECK(wholeOf(v) == s.read());
    CHECK(wholeOf(w) == most.read());
    running.with(options)(x, s);
    running.with(options)(u, u);  // in place
    CHECK(wholeOf(u) == s.read());
  });
}

TEST_CASE("scans keep the order of elements") {
  sk::Device device("native");
  auto x = device.stream<std::uint32_t>(shape);
  auto p = device.stream<Polynomial>(shape);
  x.write(valuesOf<std::uint32_t>());
  forEachScan([&](sk::Domain& domain, const sk::CallOptions& options) {
    auto u = domain.stream<std::uint32_t>();
    auto q = domain.stream<Polynomial>();
    u.fill([](const sk::Index& i) { return static_cast<std::uint32_t>(number(i)); });
    hashed.with(options)(x, p);
    hashed.with(options)(u, q);
    const std::vector<Polynomial> got = wholeOf(q), expected = p.read();
    bool areSame = true;
    for (std::size_t k = 0; k < got.size(); ++k)
      areSame = areSame && got[k].value == expected[k].value && got[k].power == expected[k].power;
    CHECK(areSame);
  });
}

TEST_CASE("scans of floats are off by one rounding for each rank before, and those of one device") {
  const auto wild = [](const sk::Index& i) {
    return std::ldexp(static_cast<float>(number(i)) + 0.3F, static_cast<int>((i[0] + i[1]) % 17) - 8);
  };
  forEachScan([&](sk::Domain& domain, const sk::CallOptions& options) {
    auto u = domain.stream<float>(), v = domain.stream<float>();
    u.fill(wild);
    summed.with(options)(u, v);
    const std::vector<float> got = wholeOf(v);
    // Each rank's results, the total of each rank before, and their combinations are rounded once: together at most
    // 2 * ranks + 1 roundings of numbers that are at most the sum of magnitudes (docs/domains.md).
    const double unit = std::ldexp(1.0, -24);
    const bool isExclusive = options.scan == sk::Scan::Exclusive;
    double worst = 0;
    std::vector<double> sums(14), magnitudes(14);
    double sum = 0, magnitude = 0;
    for (std::int64_t k = 0; k < shape.size(); ++k) {
      const sk::Index i{k / 14, k % 14};
      if (options.along == 1 && i[1] == 0) sum = magnitude = 0;
      double& exact = options.along == 0 ? sums[static_cast<std::size_t>(i[1])] : sum;
      double& size = options.along == 0 ? magnitudes[static_cast<std::size_t>(i[1])] : magnitude;
      const double before = exact;
      exact += static_cast<double>(wild(i));
      size += std::abs(static_cast<double>(wild(i)));
      const double error =
          std::abs(static_cast<double>(got[static_cast<std::size_t>(k)]) - (isExclusive ? before : exact));
      worst = std::max(worst, error / (unit * std::max(size, 1e-30)));
    }
    CHECK(worst <= 2 * domain.ranks() + 1);
  });
}

TEST_CASE("scans that ranks cannot share are refused with a way out") {
  using Catch::Contains;
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .split = {1, ranksOfWorld()}});
  auto u = domain.stream<int>(), v = domain.stream<int>();
  auto x = domain.stream<float>();
  auto own = domain.device().stream<int>(shape);
  u.fill(1);
  x.fill(1.0F);
  CHECK_THAT(errorOf([&] { running(u, v); }),
             Contains("goes on from row to row") &&
                 Contains(".split = {" + std::to_string(ranksOfWorld()) + ", 1}"));
  CHECK_THAT(errorOf([&] { running.with({.along = 2})(u, v); }), Contains("along is 0 to 1"));
  CHECK_THAT(errorOf([&] { running.with({.along = 1})(u, own); }),
             Contains("'s' is no stream of the domain") && Contains("domain.stream"));
  CHECK_THAT(errorOf([&] { placed.with({.along = 1})(u, v); }), Contains("let a kernel store"));
  CHECK_THAT(errorOf([&] { gathered.with({.along = 1})(u, u, v); }), Contains("'u'"));
  CHECK_THAT(errorOf([&] { summed.with({.accumulate = sk::Accumulate::Exact, .along = 1})(x, x); }),
             Contains("exact scans of floats") && Contains("dimension 1"));
  CHECK_THAT(errorOf([&] { running.with({.along = 1, .box = {{0, 0}, {2, 2}}})(u, v); }), Contains("no box"));
}

}  // namespace
