// SPDX-License-Identifier: MIT
//
// Grids of several sizes on the same ranks: streams are copied to and from ordinary streams of the whole with their bits.
#include <algorithm>
#include <bit>
#include <cstring>

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

}  // namespace
