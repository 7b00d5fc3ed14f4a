// SPDX-License-Identifier: MIT
//
// The model of `sk scale` counts what ranks really send.
#include <catch2/catch.hpp>

#include "files.sk.hpp"
#include "ranks.hpp"
#include "scale/model.hpp"
#include "sk/mpi.hpp"

namespace {

using sk_tool::ExchangedStream;
using sk_tool::Extents;
using sk_tool::Halo;

/// What the model says of one exchange by this rank.
sk_tool::Sent modelOf(const sk::Domain& domain, const std::vector<bool>& periodic,
                      const std::vector<ExchangedStream>& streams) {
  sk_tool::Split split{.parts = {}, .periodic = periodic};
  Extents block, place;
  std::int64_t rank = domain.rank(), ranks = domain.ranks();
  for (int d = 0; d < domain.shape().rank(); ++d) {
    const std::int64_t parts = domain.split()[d];
    ranks /= parts;
    split.parts.push_back(parts);
    place.push_back(rank / ranks % parts);
    block.push_back(sk_tool::partExtent(domain.shape()[d], parts, place.back()));
    CHECK(block.back() == domain.own().end[d] - domain.own().begin[d]);
  }
  return sentBy(split, block, place, streams);
}

void checkCounts(const sk::Domain& domain, const std::vector<bool>& periodic,
                 const std::vector<ExchangedStream>& streams, std::int64_t exchanges) {
  const sk_tool::Sent sent = modelOf(domain, periodic, streams);
  CHECK(domain.statistics().messages == exchanges * sent.messages);
  CHECK(static_cast<double>(domain.statistics().bytes) == static_cast<double>(exchanges) * sent.bytes);
}

/// Returns every way to divide `rank` dimensions among the ranks.
std::vector<Extents> splits(std::size_t rank) { return sk_tool::processGrids(ranksOfWorld(), rank); }

sk::Index indexOf(const Extents& parts) {
  return parts.size() == 2 ? sk::Index{parts[0], parts[1]} : sk::Index{parts[0], parts[1], parts[2]};
}

}  // namespace

TEST_CASE("one stream, both sides alike, with and without wrapping") {
  for (const Extents& parts : splits(2)) {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = {19, 23}, .periodic = {true, true}, .split = indexOf(parts)});
    auto u = domain.stream<float>();
    u.fill(1.0F);
    for (int step = 0; step < 3; ++step) diffuse(0.2F, u, u);
    checkCounts(domain, {true, true}, {{.bytes = 4, .halo = {{1, 1}, {1, 1}}}}, 3);
  }
}

TEST_CASE("exchanges that calls share") {
  for (const Extents& parts : splits(2)) {
    sk::Domain domain(
        MPI_COMM_WORLD,
        {.shape = {19, 23}, .periodic = {true, true}, .split = indexOf(parts), .exchangeEvery = 3});
    auto u = domain.stream<float>();
    u.fill(1.0F);
    for (int step = 0; step < 6; ++step) diffuse(0.2F, u, u);
    checkCounts(domain, {true, true}, {{.bytes = 4, .halo = {{3, 3}, {3, 3}}}}, 2);
    const sk_tool::ScaledStep step{
        .grid = {19, 23},
        .periodic = {true, true},
        .calls = {{.name = "diffuse",
                   .gathers = {{.name = "u", .stream = {.bytes = 4, .halo = {{1, 1}, {1, 1}}}}}}}};
    const auto one = predict(step, {}, parts, 3, 1);
    REQUIRE(one);
    // The model tells of the rank with the largest block and the most neighbours; in a domain that wraps, that is rank 0.
    if (domain.rank() == 0) {
      CHECK(one->messages == Approx(static_cast<double>(domain.statistics().messages) / 6));
      CHECK(one->bytes == Approx(static_cast<double>(domain.statistics().bytes) / 6));
    }
  }
}

TEST_CASE("two streams in one message, read farther before than after") {
  for (const Extents& parts : splits(2)) {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = {19, 23}, .periodic = {true, true}, .split = indexOf(parts)});
    auto u = domain.stream<sk::float2>(), v = domain.stream<sk::float2>();
    auto w = domain.stream<float>();
    u.fill(sk::float2{1, 2});
    w.fill(1.0F);
    skewed(u, w, v);
    checkCounts(domain, {true, true},
                {{.bytes = 8, .halo = {{1, 2}, {2, 1}}}, {.bytes = 4, .halo = {{0, 1}, {0, 0}}}}, 1);
  }
}

TEST_CASE("three dimensions") {
  for (const Extents& parts : splits(3)) {
    sk::Domain domain(MPI_COMM_WORLD,
                      {.shape = {13, 14, 15}, .periodic = {true, true, true}, .split = indexOf(parts)});
    auto u = domain.stream<float>(), v = domain.stream<float>();
    u.fill(1.0F);
    inSpace(u, v);
    checkCounts(domain, {true, true, true}, {{.bytes = 4, .halo = {{0, 2}, {1, 0}, {0, 1}}}}, 1);
  }
}
