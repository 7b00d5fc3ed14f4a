// SPDX-License-Identifier: MIT
//
// Promises: what one rank refuses, all refuse with its words, and the domain goes on afterwards; what only one rank can throw, the
// others hear of at their next call; and ranks that make different calls are told so, whenever it happens.
#include <catch2/catch.hpp>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/stream_state.hpp"
#include "domain.sk.hpp"
#include "domain_state.hpp"
#include "error_of.hpp"
#include "ranks.hpp"
#include "reductions.sk.hpp"
#include "refusals.sk.hpp"
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
  const std::string name(10'000, 'v');  // longer than what a rank tells the others of its error
  options = {.shape = {24, 8}};
  if (isLast()) options.device.device = name;
  const std::string words = errorOf([&] { sk::Domain(MPI_COMM_WORLD, options); });
  CHECK_THAT(words, Contains(last()) && Contains(name.substr(0, 1000)));
  if (!isLast()) CHECK(words.size() < name.size());
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

TEST_CASE("handlers may call anything, in the same order on all ranks") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  auto table = domain.device().stream<float>({24, 8});
  const auto recover = [&] {
    u.fill(1.0F);
    scaled(2.0F, u, u, v);  // has no messages
    u.copyTo(v);
    auto more = domain.stream<float>();
    more.fill(0.0F);
    checkThatItWorks(u, v);
  };
  recover();
  for (int round = 0; round < 2; ++round) {
    const std::string error = errorOf([&] {
      isLast() ? scaled(0.1F, table, u, v) : scaled(0.1F, u, u, v);
      scaled(0.1F, u, u, v);
      (void)sum(u);
    });
    CHECK_THAT(error, Contains("scaled: 'x'"));
    recover();
  }
}

TEST_CASE("ranks agree on what they write") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  const std::vector<float> own(u.read().size(), 3.0F);
  CHECK_THAT(errorOf([&] { u.write(isLast() ? std::vector<float>(1) : own); }), Contains(last()));
  u.write(own);
  CHECK(sum(u) == 3.0F * 24 * 8);
  const auto start = [](const sk::Index&) {
    if (isLast()) throw std::runtime_error("no start");
    return 2.0F;
  };
  CHECK_THAT(errorOf([&] { u.fill(start); }), Contains(last() + "fill: no start"));
}

TEST_CASE("calls have as many arguments as their kernels declare") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  const std::array parameters{sk::program::Parameter{.name = "r",
                                                     .symbol = "r",
                                                     .role = sk::program::Role::Output,
                                                     .element = &sk::ElementTraits<float>::element()}};
  sk::program::Kernel kernel;
  kernel.name = "alone";
  kernel.parameters = parameters;
  const std::array arguments{sk::Argument{nullptr, regionOf(u)}, sk::Argument{nullptr, regionOf(v)}};
  CHECK_THAT(errorOf([&] { sk::run(kernel, arguments); }),
             Contains("alone: 2 arguments are given, but 1 are declared"));
  std::array folded{parameters[0], parameters[0]};
  folded[0].role = sk::program::Role::Input;
  folded[1].role = sk::program::Role::Accumulator;
  sk::program::Reduction reduction{};
  reduction.fold = kernel;
  reduction.fold.parameters = folded;
  const std::array given{arguments[0], sk::Argument{}};
  CHECK_THAT(errorOf([&] { sk::scan(reduction, std::span(given).first(1)); }),
             Contains("alone: 1 arguments are given, but 2 are declared"));
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

TEST_CASE("a future may outlive its domain, and says that its value has ended") {
  sk::Future<float> kept, destroyed;
  {
    sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
    auto u = domain.stream<float>();
    u.fill(1.0F);
    kept = domain.later(sum, u);
    destroyed = domain.later(sum, u);
  }
  CHECK(kept.ready());
  kept.wait();
  CHECK_THAT(errorOf([&] { (void)kept.get(); }), Contains("the sk::Domain of this future has ended"));
}

TEST_CASE("a recording cannot write the elements of a domain") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  u.fill(1.0F);
  v.fill(7.0F);
  const auto messageOf = [&](const std::function<void()>& body) {
    return errorOf([&] { (void)domain.device().record(body); });
  };
  CHECK_THAT(messageOf([&] { u.fill(5.0F); }), Contains("cannot be written while calls are recorded"));
  CHECK_THAT(messageOf([&] { v.copyTo(u); }), Contains("cannot be written while calls are recorded"));
  checkThatItWorks(u, v);
}

TEST_CASE("ranks compare all choices of a call") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  const sk::CallOptions choices[] = {{.intrinsics = sk::Intrinsics::Fast},
                                     {.contraction = sk::Contraction::Fast},
                                     {.tables = sk::Tables::On}};
  for (const sk::CallOptions& choice : choices) {
    u.fill([](const sk::Index&) { return 1.0F; });
    CHECK(errorOf([&] { diffuse.with(isLast() ? choice : sk::CallOptions{})(0.125F, u, v); }) != "");
    checkThatItWorks(u, v);
  }
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

// MPI would end the run if the messages had different lengths.
TEST_CASE("ranks that fold differently are told so, however long their messages are", "[collectives]") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  sk::Domain columns(domain, {.shape = {400, 8}, .split = {1, ranksOfWorld()}});
  auto u = domain.stream<float>(), v = domain.stream<float>(), c = columns.stream<float>();
  auto n = columns.stream<unsigned>();
  u.fill(1.0F);
  c.fill(1.0F);
  n.fill(1U);
  const auto exactly = dot.with({.accumulate = sk::Accumulate::Exact});
  const auto upper = sum.with({.box = {{0, 0}, {1, 8}}}), lower = sum.with({.box = {{1, 0}, {24, 8}}});
  const auto differ = [&](const std::function<void()>& one, const std::function<void()>& other) {
    for (const bool areKnown : {false, true}) {
      if (areKnown) {
        one();
        other();
      }
      CHECK_THAT(errorOf([&] { isLast() ? one() : other(); }), Contains("do not make the same call"));
      checkThatItWorks(u, v);
      CHECK_THAT(errorOf([&] { isLast() ? other() : one(); }), Contains("do not make the same call"));
      checkThatItWorks(u, v);
    }
  };
  differ([&] { (void)largest(u); }, [&] { (void)sum(u); });
  differ([&] { (void)exactly(u, u); }, [&] { (void)dot(u, u); });
  differ([&] { (void)exactly(u, u); }, [&] { (void)hash(n); });
  differ([&] { (void)hash(n); }, [&] { (void)sum(u); });
  differ([&] { (void)upper(u); }, [&] { (void)lower(u); });
  differ([&] { (void)sum(c); }, [&] { (void)sum(u); });
  differ([&] { (void)domain.later(exactly, u, u).get(); }, [&] { (void)domain.later(sum, u).get(); });
  differ([&] { (void)columns.later(hash, n).get(); }, [&] { (void)domain.later(sum, u).get(); });
  u.fill(1.0F);
  CHECK_THAT(errorOf([&] {
               sk::Future<float> later = isLast() ? domain.later(largest, u) : domain.later(sum, u);
               (void)sum(u);
             }),
             Contains("do not make the same call"));
  checkThatItWorks(u, v);
}

// Their messages go to other communicators, where nobody would receive them, or have other lengths.
TEST_CASE("ranks that name streams of other domains, or of other types, are told so", "[collectives]") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around, .split = {ranksOfWorld(), 1}});
  sk::Domain another(domain, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>(), w = another.stream<float>();
  auto d = domain.stream<float>(sk::Storage::Double);
  auto whole = domain.device().stream<float>({24, 8});
  const auto differ = [&](bool isStored, const std::function<void(sk::DomainStream<float>&)>& call) {
    for (sk::DomainStream<float>* const other : {&w, &d}) {
      if (other == &d && !isStored) continue;  // elements travel as they are declared
      for (sk::DomainStream<float>* const stream : {&u, other}) stream->fill(1.0F);
      CHECK_THAT(
          errorOf([&] { call(isLast() ? *other : u); }),
          Contains("do not make the same call") || Contains("ordinary stream has another sk::Storage"));
      checkThatItWorks(u, v);
    }
  };
  const std::vector<float> all(domain.rank() == 0 ? 24 * 8 : 0, 3.0F);
  const std::string file = (std::filesystem::temp_directory_path() / "sk_mpi_refusals_never.npy").string();
  differ(true, [&](auto& stream) { diffuse(0.125F, stream, stream); });
  differ(false, [&](auto& stream) { (void)stream.gather(); });
  differ(false, [&](auto& stream) { (void)stream.gatherReals(); });
  differ(false, [&](auto& stream) { stream.scatter(all); });
  differ(true, [&](auto& stream) { stream.copyTo(whole); });
  differ(true, [&](auto& stream) { stream.save(file); });
  differ(true, [&](auto& stream) { summed.with({.along = 0})(stream, stream); });
  differ(false, [&](auto& stream) { (void)sum(stream); });
  CHECK_THAT(errorOf([&] { isLast() ? u.save(file + "1") : u.save(file + "2"); }),
             Contains("do not make the same call"));
  checkThatItWorks(u, v);
}

TEST_CASE("errors say what differs between two calls of one name", "[collectives]") {
  if (ranksOfWorld() == 1) return;
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around, .split = {ranksOfWorld(), 1}});
  sk::Domain another(domain, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>(), w = another.stream<float>();
  auto d = domain.stream<float>(sk::Storage::Double);
  auto n = domain.stream<int>();
  const std::vector<float> all(domain.rank() == 0 ? 24 * 8 : 0, 3.0F);
  const auto parts = [&](const std::string& others, const std::string& lasts,
                         const std::function<void()>& other, const std::function<void()>& one) {
    u.fill(1.0F);
    w.fill(1.0F);
    d.fill(1.0F);
    n.fill(1);
    CHECK_THAT(errorOf([&] { isLast() ? one() : other(); }),
               Contains("rank 0 has " + others) &&
                   Contains("rank " + std::to_string(ranksOfWorld() - 1) + " has " + lasts));
    checkThatItWorks(u, v);
  };
  parts("gather (root 0)", "gather (root 1)", [&] { (void)u.gather(0); }, [&] { (void)u.gather(1); });
  parts("gather (domain 1", "gather (domain 2", [&] { (void)u.gather(); }, [&] { (void)w.gather(); });
  parts(
      "gather (elements float", "gather (elements int", [&] { (void)u.gather(); }, [&] { (void)n.gather(); });
  parts(
      "scatter (storage single", "scatter (storage double", [&] { u.scatter(all); }, [&] { d.scatter(all); });
  parts(
      "save (file /never/a.npy)", "save (file /never/b.npy)", [&] { u.save("/never/a.npy"); },
      [&] { u.save("/never/b.npy"); });
  parts(
      "sum (box from {0, 0} to {2, 8})", "sum (box from {0, 0} to {4, 8})",
      [&] { (void)sum.with({.box = {{0, 0}, {2, 8}}})(u); },
      [&] { (void)sum.with({.box = {{0, 0}, {4, 8}}})(u); });
  parts(
      "sum (accumulate tree)", "sum (accumulate exact)",
      [&] { (void)sum.with({.accumulate = sk::Accumulate::Tree})(u); },
      [&] { (void)sum.with({.accumulate = sk::Accumulate::Exact})(u); });
  parts(
      "diffuse (precision double)", "diffuse (precision single)",
      [&] { diffuse.with({.precision = sk::Precision::Double})(0.1F, u, v); },
      [&] { diffuse.with({.precision = sk::Precision::Single})(0.1F, u, v); });
  parts(
      "summed (along 0)", "summed (exclusive)", [&] { summed.with({.along = 0})(u, v); },
      [&] { summed.with({.scan = sk::Scan::Exclusive})(u, v); });
  sk::DomainOptions options{.shape = {24, 8}, .periodic = {true, isLast()}};
  const std::string domains = errorOf([&] { sk::Domain(MPI_COMM_WORLD, options); });
  CHECK_THAT(domains, Contains("periodic {true, false}") && Contains("periodic {true, true}"));
  CHECK_THAT(errorOf([&] { sk::Domain(domain, options); }), Contains("periodic {true, false}"));
  checkThatItWorks(u, v);
}

TEST_CASE("with SK_CHECK=written, a part of which nothing has been written is not read", "[.][written]") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around, .exchangeEvery = 2});
  auto u = domain.stream<float>(), v = domain.stream<float>();
  auto whole = domain.device().stream<float>({24, 8});
  CHECK_THAT(errorOf([&] { diffuse(0.1F, u, v); }), Contains("diffuse: ") && Contains("nothing has written"));
  CHECK_THAT(errorOf([&] { static_cast<void>(v.gather()); }), Contains("nothing has written"));
  CHECK_THAT(errorOf([&] { whole.read(); }), Contains("nothing has written"));
  u.fill(1.0F);
  for (int step = 0; step < 3; ++step) {
    CHECK(errorOf([&] { diffuse(0.1F, u, v); }) == "no error");
    CHECK(errorOf([&] { diffuse(0.1F, v, u); }) == "no error");
  }
  CHECK(errorOf([&] { static_cast<void>(sum(v)); }) == "no error");
  u.copyTo(whole);
  CHECK(errorOf([&] { whole.read(); }) == "no error");
}

TEST_CASE("with SK_CHECK=written, reductions and folded outputs do not read a part that nothing has written",
          "[.][written]") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around, .split = {ranksOfWorld(), 1}});
  auto u = domain.stream<float>(), v = domain.stream<float>(), w = domain.stream<float>();
  sk::Scalar<float> total = domain.device().scalar<float>();
  const sk::Box upper{{0, 0}, {12, 8}};
  w.fill(1.0F);
  boundedCopy.with({.box = upper})(w, u, total);  // all of rank 0 and nothing of rank 1
  const auto finds = [&](const auto& call) {
    CHECK_THAT(errorOf(call), Contains(last()) && Contains("nothing has written"));
  };
  finds([&] { static_cast<void>(sum(u)); });
  finds([&] { static_cast<void>(sum.with({.accumulate = sk::Accumulate::Exact})(u)); });
  finds([&] { static_cast<void>(domain.later(sum, u).get()); });
  finds([&] { boundedCopy(u, v, total); });
  finds([&] { static_cast<void>(boundedNeighbors.over({24, 8})(u)); });
  finds([&] { bounded.with({.box = upper})(u, v); });  // reads the first row of rank 1
  const auto passes = [&](const auto& call) {
    CHECK(errorOf([&] {
            call();
            static_cast<void>(sum(w));
          }) == "no error");
  };
  passes([&] { static_cast<void>(sum.with({.box = upper})(u)); });
  passes([&] { scaled.with({.box = upper})(1.0F, u, u, v); });
  passes([&] { boundedCopy(w, u, total); });
  passes([&] { static_cast<void>(sum(u)); });
}

TEST_CASE("with SK_CHECK=asserts, a rank evaluates all assertions of its part before it writes",
          "[.][asserts]") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around, .split = {ranksOfWorld(), 1}});
  auto u = domain.stream<float>(), v = domain.stream<float>(), w = domain.stream<float>();
  sk::Scalar<float> total = domain.device().scalar<float>();
  w.fill(1.0F);
  u.fill([](sk::Index at) { return at == sk::Index{18, 3} || at == sk::Index{12, 5} ? 200.0F : 1.0F; });
  const auto finds = [&](const auto& call) {
    v.fill(-1.0F);
    CHECK_THAT(errorOf([&] {
                 call();
                 static_cast<void>(sum(w));
               }),
               Contains(isLast() ? "" : last()) && Contains("failed in") && Contains("[12][5]"));
    if (isLast()) CHECK(v.read() == std::vector<float>(v.read().size(), -1.0F));
  };
  finds([&] { static_cast<void>(boundedSum(u)); });
  finds([&] { static_cast<void>(boundedSum.with({.accumulate = sk::Accumulate::Exact})(u)); });
  finds([&] { boundedSum(u, total); });
  finds([&] { static_cast<void>(domain.later(boundedSum, u).get()); });
  finds([&] { static_cast<void>(boundedNeighbors.over({24, 8})(u)); });
  finds([&] { boundedCopy(u, v, total); });
  bounded(w, v);
  finds([&] { bounded(u, v); });  // row 12 is at the border of rank 1, row 18 in its interior
  CHECK(errorOf([&] { static_cast<void>(boundedSum.with({.box = {{0, 0}, {12, 8}}})(u)); }) == "no error");
  u.fill([](sk::Index at) { return static_cast<float>(at[0]); });
  CHECK(errorOf([&] { numbered.with({.along = 0})(u, v); }) == "no error");
  CHECK(errorOf([&] { numbered.with({.along = 1})(u, v); }) == "no error");
  u.fill([](sk::Index at) { return static_cast<float>(at[0] + (at == sk::Index{12, 5} ? 1 : 0)); });
  finds([&] { numbered.with({.along = 0})(u, v); });
  finds([&] { numbered.with({.along = 1})(u, v); });
  CHECK(errorOf([&] { static_cast<void>(sum(w)); }) == "no error");
}

TEST_CASE(
    "with SK_CHECK=ranges, a rank checks its own elements, and all ranks the totals, before anything is "
    "written",
    "[.][ranges]") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around, .split = {ranksOfWorld(), 1}});
  auto u = domain.stream<float>(), v = domain.stream<float>(), w = domain.stream<float>();
  sk::Scalar<float> total = domain.device().scalar<float>();
  w.fill(1.0F);
  total = 7.0F;
  // what one rank finds alone, the others hear of in their next call that has messages
  const auto finds = [&](const char* message, const auto& call) {
    v.fill(-1.0F);
    CHECK_THAT(errorOf([&] {
                 call();
                 static_cast<void>(sum(w));
               }),
               Contains(message));
    if (isLast()) CHECK(v.read() == std::vector<float>(v.read().size(), -1.0F));
    CHECK(total.read() == 7.0F);
  };
  const auto fillWith = [&](float value) {
    u.fill([&](sk::Index at) { return at == sk::Index{12, 5} ? value : 1.0F; });
  };
  fillWith(120);
  finds("'u' is 120 at {12, 5}", [&] { ranged(u, v); });
  finds("'x' is 120 at {12, 5}", [&] { static_cast<void>(rangedSum(u)); });
  finds("'x' is 120 at {12, 5}", [&] { rangedCopy(u, v, total); });
  finds("'x' is 120 at {12, 5}", [&] { rangedScan.with({.along = 0})(u, v); });
  finds("'x' is 120 at {12, 5}", [&] { rangedScan.with({.along = 1})(u, v); });
  fillWith(-99);
  finds("'u' is -99 at {12, 5}", [&] { ranged(u, v); });
  finds("'r' would be -198 at {12, 5}", [&] { rangedCopy(u, v, total); });
  fillWith(99);
  finds("'s' would be 104 at {12, 5}", [&] { rangedScan.with({.along = 1})(u, v); });
  finds("'s' would be 111 at {12, 5}", [&] { rangedScan.with({.along = 0})(u, v); });
  fillWith(100);
  finds("'v' would be 99.5 at {12, 5}", [&] { ranged(u, v); });
  fillWith(50);
  CHECK(errorOf([&] { ranged(u, v); }) == "no error");
  CHECK(errorOf([&] { ranged(w, v); }) == "no error");
  // no rank's own total is out of range, and no rank's own total counts
  u.fill([](sk::Index at) { return at[0] < 12 ? -1.0F : 2.0F; });
  CHECK(errorOf([&] { CHECK(rangedSum(u) == 96); }) == "no error");
  CHECK(errorOf([&] { rangedCopy(u, v, total); }) == "no error");
  CHECK(total.read() == 96.0F);
  total = 7.0F;
  u.fill(3.0F);
  finds("'total' would be 576", [&] { static_cast<void>(rangedSum(u)); });
  finds("'total' would be 576",
        [&] { static_cast<void>(rangedSum.with({.accumulate = sk::Accumulate::Exact})(u)); });
  finds("'total' would be 576", [&] { rangedSum(u, total); });
  finds("'total' would be 576", [&] { static_cast<void>(domain.later(rangedSum, u).get()); });
  finds("'total' would be 576", [&] { rangedCopy(u, v, total); });
  CHECK(errorOf([&] { static_cast<void>(sum(w)); }) == "no error");
}

TEST_CASE("with SK_CHECK=collectives, the ranks compare all that they call", "[.][collectives]") {
  sk::Domain domain(MPI_COMM_WORLD, {.shape = {24, 8}, .periodic = around});
  auto u = domain.stream<float>(), v = domain.stream<float>(), w = domain.stream<float>();
  auto whole = domain.device().stream<float>({24, 8});
  whole.fill(1.0F);
  const auto parts = [&](const std::string& others, const std::string& lasts,
                         const std::function<void()>& other, const std::function<void()>& one) {
    w.fill(1.0F);
    for (const bool areKnown : {false, true}) {
      if (areKnown) {
        other();
        one();
      }
      CHECK_THAT(errorOf([&] { isLast() ? one() : other(); }),
                 Contains("rank 0 has " + others) &&
                     Contains("rank " + std::to_string(ranksOfWorld() - 1) + " has " + lasts));
      checkThatItWorks(u, v);
    }
  };
  parts(
      "scaled (x = stream 1 of domain 1)", "scaled (x = stream 3 of domain 1)",
      [&] { scaled(1.0F, u, v, v); }, [&] { scaled(1.0F, w, v, v); });
  parts(
      "diffuse (u = stream 1 of domain 1", "diffuse (u = stream 3 of domain 1", [&] { diffuse(0.1F, u, v); },
      [&] { diffuse(0.1F, w, v); });
  parts(
      "scaled (a = 0.5)", "scaled (a = 0.25)", [&] { scaled(0.5F, u, v, v); },
      [&] { scaled(0.25F, u, v, v); });
  parts(
      "sum (x = stream 1 of domain 1)", "sum (x = stream 3 of domain 1)", [&] { (void)sum(u); },
      [&] { (void)sum(w); });
  parts(
      "sum (x = stream 1 of domain 1)", "sum (x = stream 3 of domain 1)",
      [&] { (void)domain.later(sum, u).get(); }, [&] { (void)domain.later(sum, w).get(); });
  parts("gather (stream 1)", "gather (stream 3)", [&] { (void)u.gather(); }, [&] { (void)w.gather(); });
  parts("fill (stream 1)", "fill (stream 3)", [&] { u.fill(1.0F); }, [&] { w.fill(1.0F); });
  parts("copyTo (target stream 1)", "copyTo (target stream 3)", [&] { v.copyTo(u); }, [&] { v.copyTo(w); });
  parts("copyFrom (stream 1)", "copyFrom (stream 3)", [&] { u.copyFrom(whole); }, [&] { w.copyFrom(whole); });
  parts("sum", "fill", [&] { (void)sum(u); }, [&] { u.fill(1.0F); });
}
