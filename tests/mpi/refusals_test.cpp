// SPDX-License-Identifier: MIT
//
// Promises: what one rank refuses, all refuse with its words, and the domain goes on afterwards; what only one rank can throw, the
// others hear of at their next call; and ranks that make different calls are told so, whenever it happens.
#include <catch2/catch.hpp>

#include <string>

#include "device/stream_state.hpp"
#include "domain.sk.hpp"
#include "domain_state.hpp"
#include "error_of.hpp"
#include "ranks.hpp"
#include "reductions.sk.hpp"
#include "sk/mpi.hpp"

namespace {

using Catch::Contains;

constexpr std::array<bool, sk::maxRank> around = {true, true, true, true};

bool isLast() { return rankOfWorld() == ranksOfWorld() - 1; }
std::string last() { return "rank " + std::to_string(ranksOfWorld() - 1) + ": "; }

/// As after a write of this rank that has failed.
void lose(const sk::DomainStream<float>& stream) { stream.state()->placed().stream->markLost(); }

/// A stream of ordinary elements, and whether they are those of a healthy domain.
void checkThatItWorks(sk::DomainStream<float>& u, sk::DomainStream<float>& v) {
  u.fill(2.0F);
  v.fill(0.0F);
  diffuse(0.125F, u, v);
  CHECK(v.read() == std::vector<float>(v.read().size(), 2.0F));
  CHECK(sum(v) == 2.0F * static_cast<float>(v.size()));
}

}  // namespace

TEST_CASE("options that one rank cannot have are refused by all, with its words") {
  if (ranksOfWorld() == 1) return;
  sk::DomainOptions options{.shape = {24, 8}};
  if (isLast()) options.exchangeEvery = 0;
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, options); }),
             Contains(last() + "sk::Domain: exchangeEvery is 0"));
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  options = {.shape = {24, 8}};
  if (isLast()) options.shape = {0, 8};
  CHECK_THAT(errorOf([&] { sk::Domain(domain, options); }), Contains(last()) && Contains("has no element"));
  options = {.shape = {24, 8}};
  if (isLast()) options.device.device = "voodoo";
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, options); }), Contains(last()) && Contains("voodoo"));
  options = {.shape = {24, 8}, .exchangeEvery = isLast() ? 2 : 1};
  CHECK_THAT(errorOf([&] { sk::Domain(MPI_COMM_WORLD, options); }),
             Contains("rank 0 has a domain of shape {24, 8}") && Contains("exchangeEvery 2"));
  auto u = domain.stream<float>(), v = domain.stream<float>();
  checkThatItWorks(u, v);
}

TEST_CASE("a stream that is lost on one rank is refused by all, where it has messages") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  auto whole = domain.device().stream<float>({24, 8});
  const auto refuses = [&](const std::function<void()>& call) {
    u.fill(1.0F);
    if (isLast()) lose(u);
    CHECK_THAT(errorOf(call), Contains(last()) && Contains("lost"));
    checkThatItWorks(u, v);
  };
  refuses([&] { diffuse(0.125F, u, v); });
  refuses([&] { (void)sum(u); });
  refuses([&] { (void)u.gather(); });
  refuses([&] { (void)u.gatherReals(); });
  refuses([&] { u.copyTo(whole); });
  refuses([&] { u.save("never.npy"); });
}

TEST_CASE("a lost stream is whole again once all ranks write it") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(1.0F);
  diffuse(0.125F, u, v);  // so that it has a halo
  const std::vector<float> own(u.read().size(), 3.0F);
  lose(u);
  u.write(own);
  CHECK(u.read() == own);
  lose(u);
  u.fill([](const sk::Index&) { return 3.0F; });
  CHECK(u.read() == own);
  lose(u);
  u.scatter(std::vector<float>(domain.rank() == 0 ? 24 * 8 : 0, 3.0F));
  CHECK(u.read() == own);
  lose(v);
  u.copyTo(v);
  CHECK(v.read() == own);
}

TEST_CASE("all ranks throw for a wrong argument of one rank, in that call or in their next one") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(1.0F);
  v.fill(1.0F);
  auto table = domain.device().stream<float>({24, 8});
  const auto wrong = [&] { isLast() ? diffuse(0.1F, table, v) : diffuse(0.1F, u, v); };
  CHECK_THAT(errorOf(wrong), Contains(last() + "diffuse: 'u' is an ordinary stream"));
  checkThatItWorks(u, v);
  CHECK_THAT(errorOf([&] { (void)u.gather(isLast() ? 99 : 0); }),
             Contains("no rank 99") || Contains("same call"));
  checkThatItWorks(u, v);
  scaled(0.1F, u, u, v);  // compared
  const std::string alone = errorOf([&] { isLast() ? scaled(0.1F, table, u, v) : scaled(0.1F, u, u, v); });
  CHECK((alone == "no error") == !isLast());
  if (!isLast()) CHECK_THAT(errorOf([&] { (void)sum(u); }), Contains(last() + "scaled: 'x'"));
  checkThatItWorks(u, v);
  // All ranks make the same mistake: each throws its own error, without a rank's number.
  CHECK_THAT(errorOf([&] { scaled(0.1F, table, u, v); }), Contains("scaled: 'x'") && !Contains("rank 0"));
  checkThatItWorks(u, v);
}

TEST_CASE("what fails in later() on one rank is heard of by the others") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  for (const bool hasCallBetween : {false, true}) {
    u.fill(1.0F);
    v.fill(1.0F);
    if (isLast()) lose(u);
    const std::string error = errorOf([&] {
      sk::Future<float> later = domain.later(sum, u);
      if (hasCallBetween) diffuse(0.125F, v, v);
      (void)later.get();
    });
    CHECK_THAT(error, Contains(last()) && Contains("lost"));
    checkThatItWorks(u, v);
  }
  sk::Future<float> first = domain.later(sum, u), second = domain.later(sum, v);
  diffuse(0.125F, u, u);
  CHECK(second.get().front() == 2.0F * 24 * 8);
  CHECK(first.get().front() == 2.0F * 24 * 8);
}

TEST_CASE("ranks that part later are told so at the next call that has messages") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  checkThatItWorks(u, v);
  scaled(1.0F, u, u, v);
  if (isLast()) scaled(1.0F, u, u, v);  // one more call, which needs no message
  CHECK_THAT(errorOf([&] { (void)sum(u); }),
             Contains("do not make the same call") && Contains("sum as its call"));
  checkThatItWorks(u, v);
  u.fill(1.0F);  // so that its halo is exchanged
  CHECK_THAT(errorOf([&] { isLast() ? (void)sum(u) : diffuse(0.125F, u, v); }),
             Contains("do not make the same call") && Contains("rank 0 has diffuse"));
  checkThatItWorks(u, v);
}

// Their messages have different lengths, of which MPI would end the run.
TEST_CASE("ranks that fold differently are told so with SK_CHECK=collectives", "[.collectives]") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(1.0F);
  CHECK_THAT(errorOf([&] { isLast() ? (void)largest(u) : (void)sum(u); }),
             Contains("do not make the same call"));
  checkThatItWorks(u, v);
  const auto exactly = dot.with({.accumulate = sk::Accumulate::Exact});
  CHECK_THAT(errorOf([&] { isLast() ? (void)exactly(u, u) : (void)dot(u, u); }),
             Contains("do not make the same call"));
  checkThatItWorks(u, v);
  CHECK(largest(u) == 2.0F);
  CHECK_THAT(errorOf([&] { isLast() ? (void)largest(u) : (void)sum(u); }),
             Contains("do not make the same call"));
}
