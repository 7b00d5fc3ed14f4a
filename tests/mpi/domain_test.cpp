// SPDX-License-Identifier: MIT
//
// Promises: kernels on the streams of a domain give the bits that one device gives, for any number of ranks, any split, any
// boundary mode and any option; what a call exchanges is what its reach asks for, once; kernels that cannot run on parts are
// refused on every rank, with the parameter and a way out.
#include <array>
#include <cstring>
#include <numeric>

#include <catch2/catch.hpp>

#include "device/stream_state.hpp"
#include "domain.sk.hpp"
#include "domain_state.hpp"
#include "error_of.hpp"
#include "ranks.hpp"
#include "sk/mpi.hpp"
#include "sk/sk.hpp"

namespace {

float start(const sk::Index& i) {
  std::int64_t number = 7;
  for (int d = 0; d < i.rank(); ++d) number = number * 31 + i[d] * i[d] + 3 * i[d];
  return static_cast<float>(number % 101) / 8 - 5;
}

/// start() for every index, row-major.
std::vector<float> starts(const sk::Shape& shape) {
  std::vector<float> values;
  sk::Index index = sk::Index::origin(shape.rank());
  for (std::int64_t k = 0; k < shape.size(); ++k) {
    values.push_back(start(index));
    for (int d = shape.rank() - 1; d >= 0 && ++index[d] == shape[d]; --d) index[d] = 0;
  }
  return values;
}

template <class T>
std::vector<T> wholeOf(const sk::DomainStream<T>& stream) {
  return everywhere(stream.gather());
}

template <class T>
bool areSame(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

constexpr std::array<bool, sk::maxRank> around = {true, true, true, true};

/// Splits of this number of ranks in two dimensions.
std::vector<sk::Index> splits() {
  std::vector<sk::Index> all = {{}};
  for (int rows = 1; rows <= ranksOfWorld(); ++rows) {
    if (ranksOfWorld() % rows == 0) all.emplace_back(rows, ranksOfWorld() / rows);
  }
  return all;
}

/// As after a write of each rank that has failed.
void lose(const sk::DomainStream<float>& stream) { stream.state()->placed().stream->markLost(); }

TEST_CASE("a lost stream is whole again once a kernel writes all of it") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {26, 17}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>(), expected = domain.stream<float>();
  u.scatter(starts({26, 17}));
  lose(v);
  CHECK_THROWS_AS(v.gather(), sk::Error);
  diffuse(0.125F, u, v);
  diffuse(0.125F, u, expected);
  CHECK(areSame(wholeOf(v), wholeOf(expected)));
  lose(u);
  CHECK_THROWS_AS(skewed(u, v), sk::Error);  // which needs a deeper halo
  CHECK_THROWS_AS(u.gather(), sk::Error);
  auto at = domain.stream<sk::int2>();
  placed(v, v, v, v, u, at);
  CHECK(u.gather().size() == (domain.rank() == 0 ? 26 * 17 : 0));
}

TEST_CASE("a stream is filled, gathered and scattered by the indices of the whole") {
  const sk::Shape shape{13, 9};
  for (const sk::Index& split : splits()) {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .split = split});
    CHECK(domain.ranks() == ranksOfWorld());
    CHECK(domain.rank() == rankOfWorld());
    auto u = domain.stream<float>();
    u.fill(start);
    CHECK(areSame(wholeOf(u), starts(shape)));
    CHECK(u.gather(domain.ranks() - 1).empty() == (domain.rank() != domain.ranks() - 1));

    auto v = domain.stream<float>();
    std::vector<float> given(domain.rank() == 0 ? 13 * 9 : 0);
    std::iota(given.begin(), given.end(), 0.0F);
    v.scatter(given);
    CHECK(areSame(wholeOf(v), everywhere(given)));
    const sk::Box own = v.own();
    CHECK(v.read().front() == static_cast<float>(own.begin[0] * 9 + own.begin[1]));
    v.write(v.read());
    CHECK(areSame(wholeOf(v), everywhere(given)));

    auto flags = domain.stream<bool>();
    flags.fill([](const sk::Index& i) { return i[0] == i[1]; });
    const std::vector<std::uint8_t> all = everywhere(flags.gather());
    CHECK(std::accumulate(all.begin(), all.end(), 0) == 9);
  }
}

/// Steps of `diffuse` on one device.
std::vector<float> diffused(const sk::Shape& shape, int steps) {
  sk::Device device;
  auto u = device.stream<float>(shape), v = device.stream<float>(shape);
  u.write(starts(shape));
  for (int step = 0; step < steps; ++step) {
    diffuse(0.2F, u, v);
    std::swap(u, v);
  }
  return u.read();
}

TEST_CASE("kernels that do not ask where they are run beyond the ends of a torus in one piece") {
  const sk::Shape shape{24, 24};
  sk::Device device;
  auto expected = device.stream<float>(shape), other = device.stream<float>(shape);
  expected.write(starts(shape));
  for (int step = 0; step < 4; ++step) {
    skewed(expected, other);
    spread(0.2F, other, expected);
  }
  for (const sk::Index& split : splits()) {
    for (const int every : {1, 2}) {
      sk::Domain domain(MPI_COMM_WORLD,
                        {.shape = shape, .periodic = around, .split = split, .exchangeEvery = every});
      auto u = domain.stream<float>(), v = domain.stream<float>();
      u.fill(start);
      for (int step = 0; step < 4; ++step) {
        skewed(u, v);
        spread(0.2F, v, u);
      }
      INFO("split " << sk::toString(domain.split()) << ", every " << every);
      CHECK(areSame(wholeOf(u), expected.read()));
    }
  }
}

TEST_CASE("steps on a torus have the bits of one device") {
  const sk::Shape shape{14, 12};
  const std::vector<float> expected = diffused(shape, 7);
  for (const sk::Index& split : splits()) {
    for (const int every : {1, 2}) {
      for (const bool overlap : {true, false}) {
        sk::Domain domain(
            MPI_COMM_WORLD,
            {.shape = shape, .periodic = around, .split = split, .exchangeEvery = every, .overlap = overlap});
        INFO("split " << sk::toString(domain.split()) << ", every " << every << ", overlap " << overlap);
        auto u = domain.stream<float>(), v = domain.stream<float>();
        u.fill(start);
        for (int step = 0; step < 7; ++step) {
          diffuse(0.2F, u, v);
          std::swap(u, v);
        }
        CHECK(areSame(wholeOf(u), expected));
        auto w = domain.stream<float>();
        w.fill(start);
        for (int step = 0; step < 7; ++step) diffuse(0.2F, w, w);
        CHECK(areSame(wholeOf(w), expected));
      }
    }
  }
}

TEST_CASE("halos are as deep as the kernel reads, on each side") {
  const sk::Shape shape{12, 13};
  sk::Device device;
  auto u = device.stream<float>(shape), v = device.stream<float>(shape);
  u.write(starts(shape));
  skewed(u, v);
  skewed(v, u);
  for (const sk::Index& split : splits()) {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .periodic = around, .split = split});
    INFO("split " << sk::toString(domain.split()));
    auto a = domain.stream<float>(), b = domain.stream<float>();
    a.fill(start);
    skewed(a, b);
    skewed(b, a);
    CHECK(areSame(wholeOf(a), u.read()));
  }
}

TEST_CASE("a kernel knows the whole: its indices, its extents and its ends") {
  const sk::Shape shape{13, 14};
  sk::Device device;
  auto u = device.stream<float>(shape), x = device.stream<float>(shape), v = device.stream<float>(shape);
  auto at = device.stream<sk::int2>(shape);
  u.write(starts(shape));
  x.write(starts(shape));
  placed(u, u, u, x, v, at);
  for (const sk::Index& split : splits()) {
    for (const std::array<bool, sk::maxRank>& periodic : {std::array<bool, sk::maxRank>{}, around}) {
      sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .periodic = periodic, .split = split});
      INFO("split " << sk::toString(domain.split()) << ", periodic " << periodic[0]);
      auto a = domain.stream<float>(), y = domain.stream<float>(), b = domain.stream<float>();
      auto where = domain.stream<sk::int2>();
      a.fill(start);
      y.fill(start);
      placed(a, a, a, y, b, where);
      CHECK(areSame(wholeOf(b), v.read()));
      CHECK(areSame(wholeOf(where), at.read()));
      placed(a, a, a, y, a, where);
      CHECK(areSame(wholeOf(a), v.read()));
    }
  }
}

TEST_CASE("structs in three dimensions, with a distance that a constant says and a table") {
  const sk::Shape shape{7, 6, 8};
  const auto cell = [](const sk::Index& i) {
    return Cell{{start(i), start(i) + 1, 2}, static_cast<int>(i[0] + i[2])};
  };
  const std::vector<float> weights = {0.5F, 0.25F, 0.125F};
  sk::Device device;
  auto c = device.stream<Cell>(shape), r = device.stream<Cell>(shape);
  auto table = device.stream<float>({3});
  table.write(weights);
  std::vector<Cell> cellsOfAll;
  for (std::int64_t k = 0; k < shape.size(); ++k) cellsOfAll.push_back(cell({k / 48, k / 8 % 6, k % 8}));
  c.write(cellsOfAll);
  cells(1, c, table, r);

  std::vector<sk::Index> all = {{}};
  if (ranksOfWorld() == 6) all = {{}, {3, 2, 1}, {1, 2, 3}, {6, 1, 1}};
  if (ranksOfWorld() == 4) all = {{2, 1, 2}};
  for (const sk::Index& split : all) {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .periodic = around, .split = split});
    INFO("split " << sk::toString(domain.split()));
    auto a = domain.stream<Cell>(), b = domain.stream<Cell>();
    auto copy = domain.device().stream<float>({3});
    copy.write(weights);
    a.fill(cell);
    cells(1, a, copy, b);
    const std::vector<Cell> got = wholeOf(b), expected = r.read();
    bool isSame = got.size() == expected.size();
    for (std::size_t k = 0; isSame && k < got.size(); ++k)
      isSame = got[k].n == expected[k].n && got[k].v.x == expected[k].v.x && got[k].v.z == expected[k].v.z;
    CHECK(isSame);
  }
}

TEST_CASE("a call exchanges what its reach asks for, and only what is not valid") {
  if (ranksOfWorld() == 1) return;
  const std::int64_t width = 10;
  const sk::Shape shape{4 * ranksOfWorld(), width};
  sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .periodic = around, .split = {ranksOfWorld(), 1}});
  auto u = domain.stream<float>(), v = domain.stream<float>(), x = domain.stream<float>();
  u.fill(start);
  x.fill(1.0F);
  diffuse(0.2F, u, v);
  CHECK(domain.statistics() == sk::DomainStatistics{.exchanges = 1, .messages = 2, .bytes = 2 * width * 4});
  diffuse(0.2F, u, x);  // the halo of u is valid
  CHECK(domain.statistics().exchanges == 1);
  scaled(2.0F, x, u, x);  // reads no neighbor
  CHECK(domain.statistics().exchanges == 1);
  diffuse(0.2F, v, u);
  CHECK(domain.statistics().exchanges == 2);

  sk::Domain deep(MPI_COMM_WORLD,
                  {.shape = shape, .periodic = around, .split = {ranksOfWorld(), 1}, .exchangeEvery = 3});
  auto a = deep.stream<float>(), b = deep.stream<float>();
  a.fill(start);
  for (int step = 0; step < 6; ++step) {
    diffuse(0.2F, a, b);
    std::swap(a, b);
  }
  CHECK(deep.statistics() ==
        sk::DomainStatistics{.exchanges = 2, .messages = 4, .bytes = 2 * 2 * 3 * width * 4});
}

TEST_CASE("uneven parts, one row each, and one dimension") {
  const int ranks = ranksOfWorld();
  for (const std::int64_t rows : {std::int64_t{ranks}, std::int64_t{2 * ranks + 1}}) {
    const sk::Shape shape{rows, 5};
    sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .periodic = around, .split = {ranks, 1}});
    auto u = domain.stream<float>();
    u.fill(start);
    for (int step = 0; step < 4; ++step) diffuse(0.2F, u, u);
    CHECK(areSame(wholeOf(u), diffused(shape, 4)));
  }
  const sk::Shape shape{4 * ranks + 1};
  sk::Device device;
  auto x = device.stream<float>(shape), y = device.stream<float>(shape);
  x.write(starts(shape));
  line(x, y);
  sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(start);
  line(u, v);
  CHECK(areSame(wholeOf(v), y.read()));
}

TEST_CASE("a box of the whole is computed where it lies, and a promised reach is exchanged") {
  const sk::Shape shape{12, 13};
  const sk::CallOptions boxed{.box = {{3, 1}, {8, 12}}};
  const auto drift = [](const sk::Index& i) {
    return sk::float2{static_cast<float>(i[0] % 5 - 2), static_cast<float>(i[1] % 3 - 1)};
  };
  sk::Device device;
  auto u = device.stream<float>(shape), v = device.stream<float>(shape);
  auto by = device.stream<sk::float2>(shape);
  std::vector<sk::float2> drifts;
  for (std::int64_t k = 0; k < shape.size(); ++k) drifts.push_back(drift({k / 13, k % 13}));
  u.write(starts(shape));
  v.fill(-1.0F);
  by.write(drifts);
  diffuse.with(boxed)(0.2F, u, v);
  advect(v, by, u);
  for (const sk::Index& split : splits()) {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .periodic = around, .split = split});
    INFO("split " << sk::toString(domain.split()));
    auto a = domain.stream<float>(), b = domain.stream<float>();
    auto drifted = domain.stream<sk::float2>();
    a.fill(start);
    b.fill(-1.0F);
    drifted.fill(drift);
    diffuse.with(boxed)(0.2F, a, b);
    CHECK(areSame(wholeOf(b), v.read()));
    advect(b, drifted, a);
    CHECK(areSame(wholeOf(a), u.read()));
  }
}

TEST_CASE("what cannot run on parts is refused on every rank") {
  using Catch::Contains;
  const int ranks = ranksOfWorld();
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, {.shape = {0, 3}}); }), Contains("has no element"));
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, {.shape = {30, 30}, .split = {ranks + 1, 1}}); }),
             Contains("not as many parts"));
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, {.shape = {30, 30}, .split = {ranks}}); }),
             Contains("dimensions"));
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, {.shape = {30, 30}, .exchangeEvery = 0}); }),
             Contains("exchangeEvery"));
  if (ranks == 1) return;
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, {.shape = {1, ranks - 1}}); }),
             Contains("start fewer"));

  sk::Domain domain(MPI_COMM_WORLD, {.shape = {2 * ranks, 8}, .split = {ranks, 1}});
  sk::Device other("native");
  auto u = domain.stream<float>(), v = domain.stream<float>();
  auto by = domain.stream<sk::float2>();
  auto plain = domain.device().stream<float>({2 * ranks, 8});
  u.fill(1.0F);
  by.fill(sk::float2{0, 0});
  plain.fill(1.0F);
  CHECK_THAT(errorOf([&] { unbounded(u, by, v); }),
             Contains("unbounded: how far 'u' is read along y") && Contains("[[halo(n)]]"));
  CHECK_THAT(errorOf([&] { looked(u, v); }),
             Contains("'u' is read anywhere") || Contains("'u' is read along"));
  CHECK_THAT(errorOf([&] { diffuse(0.1F, u, v); }), Contains("wraps around") && Contains(".periodic"));
  CHECK_THAT(errorOf([&] { diffuse(0.1F, plain, v); }), Contains("'u' is an ordinary stream"));
  CHECK_THAT(errorOf([&] { scaled(0.1F, u, plain, v); }),
             Contains("'y' is an ordinary stream") && Contains("domain.stream"));
  CHECK_THAT(errorOf([&] { scaled(0.1F, u, v, plain); }), Contains("'r' is an ordinary stream"));
  CHECK_THAT(errorOf([&] { deposit(u, plain); }), Contains("scatters to 'r'"));
  auto pushed = domain.device().stream<float>({1});
  CHECK_THAT(errorOf([&] { keep(u, pushed); }), Contains("pushes or scatters to 'r'"));
  CHECK_THAT(errorOf([&] { domain.device().record([&] { scaled(0.1F, u, u, v); }); }),
             Contains("cannot be recorded"));
  sk::Domain second(MPI_COMM_WORLD, {.shape = {2 * ranks, 8}});
  auto w = second.stream<float>();
  CHECK_THAT(errorOf([&] { scaled(0.1F, u, w, v); }), Contains("another sk::Domain"));

  sk::Domain thin(MPI_COMM_WORLD, {.shape = {ranks, 8}, .periodic = around, .split = {ranks, 1}});
  auto a = thin.stream<float>(), b = thin.stream<float>();
  a.fill(1.0F);
  CHECK_THAT(errorOf([&] { skewed(a, b); }), Contains("'u' needs a halo of 2") && Contains("fewer ranks"));
  CHECK_THAT(errorOf([&] { a.scatter(std::vector<float>(3)); }), Contains("scatter: 3 element(s)"));
  CHECK_THAT(errorOf([&] { (void)a.gather(ranks); }), Contains("no rank"));
}

TEST_CASE("ranks that do not make the same call are told so") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {30, 8}});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(1.0F);
  const std::string error = errorOf([&] {
    if (rankOfWorld() == 1) {
      scaled(0.1F, u, u, v);
    } else {
      beside(u, v);
    }
  });
  CHECK_THAT(error, Catch::Contains("rank 0 has beside, rank 1 has scaled"));
}

}  // namespace
