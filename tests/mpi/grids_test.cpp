// SPDX-License-Identifier: MIT
//
// Grids of several sizes on the same ranks: streams are copied to and from ordinary streams of the whole with their bits.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>

#include <catch2/catch.hpp>

#include "error_of.hpp"
#include "grids.sk.hpp"
#include "ranks.hpp"
#include "sk/mpi.hpp"

namespace {

using Catch::Contains;

template <class T>
bool areSame(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// Host memory of a Grain has bytes between its members.
bool areSame(const std::vector<Grain>& a, const std::vector<Grain>& b) {
  return std::ranges::equal(a, b, [](const Grain& g, const Grain& h) {
    return g.at.z == h.at.z && g.isHeavy == h.isHeavy && g.mass == h.mass;
  });
}

/// All elements of a stream go to an ordinary stream on each rank, and from there to another stream.
template <class T, class Start>
void checkCopies(sk::Domain& domain, sk::Storage storage, Start&& start) {
  auto from = domain.stream<T>(storage), to = domain.stream<T>(storage);
  auto whole = domain.device().stream<T>(domain.shape(), storage);
  from.fill(start);
  from.copyTo(whole);
  const auto elements = whole.read();
  CHECK(areSame(elements, everywhere(from.gather())));
  to.copyFrom(whole);
  CHECK(areSame(to.read(), from.read()));
  CHECK(areSame(everywhere(to.gather()), elements));
}

TEST_CASE("elements of every kind are copied to and from ordinary streams of the whole") {
  const sk::Shape shape{7, 6};
  for (const sk::Index& split : {sk::Index{ranksOfWorld(), 1}, sk::Index{1, ranksOfWorld()}}) {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = shape, .split = split});
    INFO("split " << sk::toString(domain.split()));
    const auto number = [](const sk::Index& i) { return static_cast<int>(i[0] * 6 + i[1]); };
    checkCopies<float>(domain, sk::Storage::Single, [&](const sk::Index& i) {
      return number(i) == 5 ? std::bit_cast<float>(0x7fc01234U) : number(i) == 6 ? -0.0F : 1.0F / number(i);
    });
    checkCopies<float>(domain, sk::Storage::Half, [&](const sk::Index& i) { return 1.0F / number(i); });
    checkCopies<int>(domain, sk::Storage::Default, number);
    checkCopies<bool>(domain, sk::Storage::Default, [&](const sk::Index& i) { return number(i) % 3 == 0; });
    checkCopies<sk::half>(domain, sk::Storage::Default,
                          [&](const sk::Index& i) { return sk::half(0.1F * static_cast<float>(number(i))); });
    checkCopies<sk::unorm8x4>(domain, sk::Storage::Default, [&](const sk::Index& i) {
      const auto at = static_cast<float>(number(i)) / 42;
      return sk::unorm8x4(at, 1 - at, at / 2, at * at);
    });
    checkCopies<Grain>(domain, sk::Storage::Default, [&](const sk::Index& i) {
      return Grain{{1, 2, static_cast<float>(number(i))}, i[0] == i[1], 1.0 / (number(i) + 3)};
    });
  }
}

TEST_CASE("doubles in streams of floats are copied with all digits") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {7, 6}});
  const sk::Storage storage = sk::Storage::Double;
  auto from = domain.stream<float>(storage), to = domain.stream<float>(storage);
  auto whole = domain.device().stream<float>({7, 6}, storage);
  std::vector<double> given;
  for (int k = 0; k < 42; ++k) given.push_back(1.0 / (k + 3));
  from.scatterReals(given);
  from.copyTo(whole);
  CHECK(whole.readReals() == given);
  to.copyFrom(whole);
  CHECK(everywhere(to.gatherReals()) == given);
}

TEST_CASE("ordinary streams that cannot hold the whole are refused") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {7, 6}});
  auto u = domain.stream<float>();
  u.fill(1.0F);
  auto wide = domain.device().stream<float>({6, 7}),
       half = domain.device().stream<float>({7, 6}, sk::Storage::Half);
  CHECK_THAT(errorOf([&] { u.copyTo(wide); }),
             Contains("copyTo: the ordinary stream has shape {6, 7}, but the domain has {7, 6}"));
  CHECK_THAT(errorOf([&] { u.copyFrom(wide); }), Contains("copyFrom: the ordinary stream has shape {6, 7}"));
  CHECK_THAT(errorOf([&] { u.copyTo(half); }), Contains("has another sk::Storage"));
  sk::Device other({.device = "native"});
  auto elsewhere = other.stream<float>({7, 6});
  CHECK_THAT(errorOf([&] { u.copyTo(elsewhere); }), Contains("domain.device().stream"));
  sk::Stream<float> none;
  CHECK_THAT(errorOf([&] { u.copyFrom(none); }), Contains("there is no stream"));
}

TEST_CASE("a copy ends the halo that was valid") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24}, .periodic = {true}});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  auto whole = domain.device().stream<float>({24});
  u.fill(1.0F);
  nextOf(u, v);
  whole.fill(2.0F);
  u.copyFrom(whole);
  nextOf(u, v);
  CHECK(everywhere(v.gather()) == std::vector<float>(24, 2.0F));
}

float start(const sk::Index& i) {
  std::int64_t number = 7;
  for (int d = 0; d < i.rank(); ++d) number = number * 31 + i[d] * i[d] + 3 * i[d];
  return static_cast<float>(number % 101) / 8 - 5;
}

/// An ordinary stream with start() of each index.
sk::Stream<float> started(sk::Device& device, const sk::Shape& shape) {
  auto stream = device.stream<float>(shape);
  std::vector<float> values;
  sk::Index index = sk::Index::origin(shape.rank());
  for (std::int64_t k = 0; k < shape.size(); ++k) {
    values.push_back(start(index));
    for (int d = shape.rank() - 1; d >= 0 && ++index[d] == shape[d]; --d) index[d] = 0;
  }
  stream.write(values);
  return stream;
}
sk::DomainStream<float> started(sk::Domain& domain, const sk::Shape& shape) {
  REQUIRE(domain.shape() == shape);
  auto stream = domain.stream<float>();
  stream.fill(start);
  return stream;
}

template <class T>
std::vector<T> wholeOf(const sk::Stream<T>& stream) {
  return stream.read();
}
template <class T>
std::vector<T> wholeOf(const sk::DomainStream<T>& stream) {
  return everywhere(stream.gather());
}

/// All splits of the ranks in two dimensions.
std::vector<sk::Index> splits() {
  std::vector<sk::Index> all;
  for (int rows = 1; rows <= ranksOfWorld(); ++rows) {
    if (ranksOfWorld() % rows == 0) all.emplace_back(rows, ranksOfWorld() / rows);
  }
  return all;
}

constexpr std::array<bool, sk::maxRank> periodic = {true, true, true, true};

/// The grids of a multigrid step, on one device or in domains.
constexpr sk::Shape fineShape{36, 48}, coarseShape{18, 24}, oddShape{37, 49};

/// Smooths, goes down to the coarse grid and up again, twice.
template <class Fine, class Coarse>
std::vector<float> cycled(Fine& fine, const sk::Shape& shape, Coarse& coarse) {
  auto u = started(fine, shape), v = started(fine, shape);
  auto c = started(coarse, coarseShape), d = started(coarse, coarseShape);
  for (int cycle = 0; cycle < 2; ++cycle) {
    smooth(u, v);
    smooth(v, u);
    coarsen(u, c);
    smooth(c, d);
    smooth(d, c);
    refine(c, u, v);
    std::swap(u, v);
  }
  return wholeOf(u);
}

TEST_CASE("a cycle over a fine and a coarse grid has the bits of one device") {
  sk::Device device;
  for (const sk::Shape& shape : {fineShape, oddShape}) {
    const std::vector<float> expected = cycled(device, shape, device);
    for (const sk::Index& split : splits()) {
      for (const int every : {1, 2}) {
        sk::Domain fine(MPI_COMM_WORLD,
                        {.shape = shape, .periodic = periodic, .split = split, .exchangeEvery = every});
        sk::Domain coarse(fine, {.shape = coarseShape, .periodic = periodic});
        INFO(sk::toString(shape) << ", split " << sk::toString(split) << ", every " << every);
        CHECK(coarse.split() == split);
        CHECK(areSame(cycled(fine, shape, coarse), expected));
      }
    }
  }
}

/// One grid read from the other one, with all boundary modes.
template <class To, class From>
std::vector<float> readAround(To& to, const sk::Shape& shape, From& from, const sk::Shape& other) {
  auto a = started(from, other), u = started(to, shape), r = started(to, shape);
  around(a, a, a, u, r);
  blur(a, a);
  around(a, a, a, u, u);
  return wholeOf(u);
}

TEST_CASE("grids whose extents are no multiples are read around the same relative place") {
  sk::Device device;
  for (const sk::Shape& large : {fineShape, oddShape}) {
    const std::vector<float> down = readAround(device, coarseShape, device, large);
    const std::vector<float> up = readAround(device, large, device, coarseShape);
    for (const sk::Index& split : splits()) {
      for (const bool isPeriodic : {false, true}) {
        sk::DomainOptions options{.shape = large, .split = split};
        if (isPeriodic) options.periodic = periodic;
        sk::Domain fine(MPI_COMM_WORLD, options);
        options.shape = coarseShape;
        sk::Domain coarse(fine, options);
        INFO("split " << sk::toString(split) << ", periodic " << isPeriodic << ", " << sk::toString(large));
        CHECK(areSame(readAround(coarse, coarseShape, fine, large), down));
        CHECK(areSame(readAround(fine, large, coarse, coarseShape), up));
      }
    }
  }
}

/// Reads grids of one dimension more.
template <class Coarse, class Stack, class FineStack>
std::vector<float> combined(Coarse& coarse, Stack& stack, FineStack& fineStack) {
  auto a = started(stack, {3, 18, 24}), fine = started(fineStack, {3, 36, 48});
  auto u = started(coarse, coarseShape), r = started(coarse, coarseShape);
  combine(a, fine, u, r);
  combine(a, fine, r, u);
  return wholeOf(u);
}

TEST_CASE("coefficients in grids of one dimension more have the bits of one device") {
  sk::Device device;
  const std::vector<float> expected = combined(device, device, device);
  for (const sk::Index& split : splits()) {
    sk::Domain coarse(MPI_COMM_WORLD, {.shape = coarseShape, .split = split});
    sk::Domain stack(coarse, {.shape = {3, 18, 24}});
    sk::Domain fineStack(coarse, {.shape = {3, 36, 48}, .split = {1, split[0], split[1]}});
    INFO("split " << sk::toString(split));
    CHECK(stack.split() == sk::Index{1, split[0], split[1]});
    CHECK(areSame(combined(coarse, stack, fineStack), expected));
  }
}

/// Reads grids of one dimension less.
template <class Coarse, class Column, class Wide>
std::vector<float> scaled(Coarse& coarse, Column& column, Wide& wide) {
  auto a = started(column, {24}), b = started(wide, {48});
  auto u = started(coarse, coarseShape), r = started(coarse, coarseShape);
  scaleColumns(a, b, u, r);
  return wholeOf(r);
}

TEST_CASE("grids of one dimension less are read where the other dimension is not divided") {
  sk::Device device;
  sk::Domain coarse(MPI_COMM_WORLD, {.shape = coarseShape, .split = {1, ranksOfWorld()}});
  sk::Domain column(coarse, {.shape = {24}}), wide(coarse, {.shape = {48}});
  CHECK(areSame(scaled(coarse, column, wide), scaled(device, device, device)));
}

TEST_CASE("reductions and folded outputs read grids of other sizes") {
  sk::Device device;
  auto fine = started(device, fineShape), u = started(device, coarseShape), r = started(device, coarseShape);
  const auto exact = [](const auto& reduce) { return reduce.with({.accumulate = sk::Accumulate::Exact}); };
  auto sum = device.stream<float>({1});
  const float total = exact(energy)(u, fine);
  exact(coarsenAndSum)(fine, u, r, sum);
  const sk::CallOptions inBox{.accumulate = sk::Accumulate::Exact, .box = {{3, 2}, {11, 14}}};
  const float part = energy.with(inBox)(u, fine);
  for (const sk::Index& split : splits()) {
    sk::Domain large(MPI_COMM_WORLD, {.shape = fineShape, .periodic = periodic, .split = split});
    sk::Domain small(large, {.shape = coarseShape, .periodic = periodic});
    INFO("split " << sk::toString(split));
    auto f = started(large, fineShape), v = started(small, coarseShape), s = started(small, coarseShape);
    CHECK(exact(energy)(v, f) == total);
    CHECK(energy.with(inBox)(v, f) == part);
    CHECK(exact(energyOf).over(coarseShape)(f, v) == total);  // the shape decides, not the first gather
    auto sumOfAll = small.device().stream<float>({1});
    exact(coarsenAndSum)(f, v, s, sumOfAll);
    CHECK(sumOfAll.read() == sum.read());
    CHECK(areSame(wholeOf(s), r.read()));
    CHECK(small.later(exact(energy), v, f).get().front() == total);
  }
}

TEST_CASE("a box of a grid is computed from another grid, whose halo is exchanged once") {
  sk::Device device;
  auto u = started(device, fineShape), c = started(device, coarseShape);
  coarsen.with({.box = {{2, 3}, {9, 14}}})(u, c);
  for (const sk::Index& split : splits()) {
    sk::Domain fine(MPI_COMM_WORLD, {.shape = fineShape, .periodic = periodic, .split = split});
    sk::Domain coarse(fine, {.shape = coarseShape, .periodic = periodic});
    INFO("split " << sk::toString(split));
    auto v = started(fine, fineShape), d = started(coarse, coarseShape);
    coarsen.with({.box = {{2, 3}, {9, 14}}})(v, d);
    CHECK(areSame(wholeOf(d), c.read()));
    coarsen(v, d);
    const std::int64_t once = ranksOfWorld() > 1 ? 1 : 0;
    CHECK(fine.statistics().exchanges == once);
    CHECK(coarse.statistics().exchanges == 0);
    smooth(v, v);
    CHECK(fine.statistics().exchanges == once);  // the halo is deep enough
    coarsen(v, d);
    CHECK(fine.statistics().exchanges == 2 * once);
  }
}

TEST_CASE("a domain may end before the one beside it") {
  auto fine = std::make_unique<sk::Domain>(MPI_COMM_WORLD, sk::DomainOptions{.shape = {36, 28}});
  sk::Domain coarse(*fine, {.shape = {18, 14}});
  auto u = fine->stream<float>(), v = coarse.stream<float>(), w = coarse.stream<float>();
  v.fill(1.0F);
  CHECK(totalOf(v) == 252);
  fine.reset();
  CHECK(totalOf(v) == 252);
  blur(v, w);
  CHECK(areSame(wholeOf(w), std::vector<float>(252, 1.0F)));
  CHECK_THAT(errorOf([&] { unpromised(u, w); }), Contains("has been destroyed"));
}

TEST_CASE("grids that ranks cannot read beside others are refused with a way out") {
  const sk::Index rows{ranksOfWorld(), 1};
  sk::Domain fine(MPI_COMM_WORLD, {.shape = {36, 28}, .split = rows});
  sk::Domain coarse(fine, {.shape = {18, 14}});
  auto u = fine.stream<float>(), v = coarse.stream<float>(), w = coarse.stream<float>();
  CHECK_THAT(errorOf([&] { added(v, u, w); }),
             Contains("added: 'y' is of another sk::Domain than the elements that the call computes"));
  sk::Domain alone(MPI_COMM_WORLD, {.shape = {36, 28}, .split = rows});
  auto a = alone.stream<float>();
  CHECK_THAT(errorOf([&] { far(a, w); }), Contains("'fine' is of a sk::Domain with a device of its own") &&
                                              Contains("sk::Domain coarse(fine"));
  if (ranksOfWorld() == 1) return;
  CHECK_THAT(errorOf([&] { unpromised(u, w); }),
             Contains("how far 'fine' is read along y is not known") && Contains("[[halo(n)]]"));
  sk::Domain columns(fine, {.shape = {36, 28}, .split = {1, ranksOfWorld()}});
  auto b = columns.stream<float>();
  CHECK_THAT(errorOf([&] { far(b, w); }), Contains("'fine' is of a sk::Domain with split {1, ") &&
                                              Contains("create both with the same .split"));
  if (ranksOfWorld() < 6) return;
  CHECK_THAT(errorOf([&] { far(u, w); }),
             Contains("'fine' needs a halo of 9 element(s) along y, but rank 5 has 6"));
}

}  // namespace
