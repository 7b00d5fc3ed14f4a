// SPDX-License-Identifier: MIT
#include "tune/judge.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <catch2/catch.hpp>

namespace {

using sk::results::Process;
using sk::results::Values;
using sk_tool::tune::errorOf;
using sk_tool::tune::Judge;
using sk_tool::tune::Metric;
using sk_tool::tune::Verdict;
using sk_tool::tune::Wanted;

template <class T>
Values valuesOf(Values::Kind kind, const std::vector<T>& numbers) {
  return {kind, std::string(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T))};
}
Values floats(const std::vector<float>& numbers) { return valuesOf(Values::Kind::Single, numbers); }
Values doubles(const std::vector<double>& numbers) { return valuesOf(Values::Kind::Double, numbers); }
Values integers(const std::vector<std::int64_t>& numbers) { return valuesOf(Values::Kind::Integer, numbers); }

constexpr double infinity = std::numeric_limits<double>::infinity();

Process processWith(const std::string& name, const Values& values, std::uint64_t hash = 0) {
  Process process;
  process.series = {{.name = name, .reads = 1, .hash = hash, .first = {values}}};
  return process;
}

}  // namespace

TEST_CASE("what the rounding of a read to floats takes of the tolerance") {
  const double third = 1.0 / 3;
  const double rounding = std::fabs(static_cast<float>(third) - third);
  const auto roundingOf = [&](Metric metric, double tolerance, const Values& read) {
    const Process base = processWith("r", read), truth = processWith("r", doubles({third}));
    return Judge(base, truth, {}, metric, tolerance, {}).judge(base).errors.front().ofRounding;
  };
  CHECK(roundingOf(Metric::Absolute, 1e-12, floats({1})) == Approx(rounding / 1e-12));
  CHECK(roundingOf(Metric::Relative, 1e-12, floats({1})) == Approx(3 * rounding / 1e-12));
  CHECK(roundingOf(Metric::Ulp, 1, floats({1})) <= 0.5);
  CHECK(roundingOf(Metric::Absolute, 1e-12, doubles({1})) == 0);
}

TEST_CASE("metrics of a read") {
  const Values truth = doubles({3, 4, 0});
  CHECK(errorOf(floats({3, 4, 0.5F}), truth, Metric::L2, false) == Approx(0.1));
  CHECK(errorOf(floats({3, 4, 0.5F}), truth, Metric::Absolute, false) == 0.5);
  CHECK(errorOf(floats({3, 4.5F, 0}), truth, Metric::Relative, false) == 0.125);
  CHECK(errorOf(floats({3, 4, 0.5F}), truth, Metric::Relative, false) == infinity);  // of a right result of 0
  CHECK(errorOf(floats({1 + 0x1p-23F}), doubles({1}), Metric::Ulp, false) == 1);
  CHECK(errorOf(floats({1}), doubles({1 - 0x1p-25}), Metric::Ulp, false) == 0.5);
  CHECK(errorOf(floats({0x1p-149F}), doubles({0}), Metric::Ulp, false) == 1);
  CHECK(errorOf(doubles({0.25, 0.75}), doubles({0.25, 0.5}), Metric::Psnr, true) ==
        Approx(0.25 / std::sqrt(2)));
  CHECK(errorOf(doubles({0, 9}), doubles({0, 10}), Metric::Psnr, false) == Approx(0.1 / std::sqrt(2)));
}

TEST_CASE("norms neither overflow nor underflow") {
  CHECK(errorOf(doubles({1.1e300, 1e300}), doubles({1e300, 1e300}), Metric::L2, false) ==
        Approx(0.1 / std::sqrt(2)));
  CHECK(errorOf(doubles({1.1e-300, 1e-300}), doubles({1e-300, 1e-300}), Metric::L2, false) ==
        Approx(0.1 / std::sqrt(2)));
  CHECK(errorOf(doubles({0, 0}), doubles({0, 0}), Metric::L2, false) == 0);
}

TEST_CASE("what is no number must be so in both") {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  for (const Metric metric : {Metric::L2, Metric::Relative, Metric::Absolute, Metric::Ulp, Metric::Psnr}) {
    CHECK(errorOf(floats({nan, inf, 1}), doubles({nan, inf, 1}), metric, false) == 0);
    CHECK(errorOf(floats({1, 1}), doubles({inf, 1}), metric, false) == infinity);
    CHECK(errorOf(floats({nan, 1}), doubles({1, 1}), metric, false) == infinity);
    CHECK(errorOf(floats({-inf, 1}), doubles({inf, 1}), metric, false) == infinity);
    CHECK(errorOf(floats({1}), doubles({1, 1}), metric, false) == infinity);
  }
}

TEST_CASE("integers are decisions: the program's own, or the right ones") {
  const Process base = processWith("n", integers({1}), 1), truth = processWith("n", integers({2}), 2);
  const Judge judge(base, truth, {}, Metric::L2, 1e-3, {});
  CHECK(judge.judge(base).decision.empty());
  CHECK(judge.judge(truth).decision.empty());
  CHECK(judge.judge(processWith("n", integers({3}), 3)).decision == "'n', of integers, has other values");
  Process twice = base;
  twice.series[0].reads = 2;
  CHECK(judge.judge(twice).decision == "'n' is read 2 time(s), not 1");
  CHECK(judge.judge(Process()).decision == "'n' is never read");
  CHECK_FALSE(judge.judge(Process()).isExact());
}

TEST_CASE("the worst read of all results decides, each by its tolerance") {
  Process base = processWith("u", floats({1}));
  base.series.push_back({.name = "v", .reads = 1, .first = {floats({1})}});
  Process run = base;
  run.series[0].first = {floats({1.5F})};
  run.series[1].first = {floats({1.25F})};
  const Judge judge(base, base, {{"u", Metric::L2, 1}, {"v", Metric::L2, 0.125}}, Metric::L2, 0, {});
  const Verdict verdict = judge.judge(run);
  CHECK(verdict.score == 2);
  CHECK(verdict.worst()->name == "v");
  CHECK(judge.judge(base).score == 0);
  const Judge inDecibels(base, base, {{"u", Metric::Psnr, 20, true}}, Metric::L2, 0, {});
  run.series[0].first = {floats({1.1F})};
  CHECK(inDecibels.judge(run).score == Approx(1).epsilon(1e-6));
  CHECK(inDecibels.judge(run).errors[0].error == Approx(20).epsilon(1e-6));
}

TEST_CASE("reads that differ from run to run are known, and left out") {
  Process a = processWith("u", floats({1}), 1), b = processWith("u", floats({1}), 1);
  a.series.push_back({.name = "time", .reads = 1, .hash = 1, .first = {floats({1})}});
  b.series.push_back({.name = "time", .reads = 1, .hash = 2, .first = {floats({2})}});
  b.series.push_back({.name = "more", .reads = 1, .hash = 1, .first = {floats({2})}});
  const std::vector<std::string> differing = sk_tool::tune::differences(a, b);
  CHECK(differing == std::vector<std::string>{"time", "more"});
  const Judge judge(a, a, {}, Metric::L2, 1e-3, differing);
  REQUIRE(judge.wanted().size() == 1);
  CHECK(judge.wanted()[0].name == "u");
}

TEST_CASE("results are named with a metric and a tolerance") {
  const Wanted plain = sk_tool::tune::parseWanted("heat::u", Metric::L2, 1e-3);
  CHECK(plain.name == "heat::u");
  CHECK(plain.tolerance == 1e-3);
  const Wanted own = sk_tool::tune::parseWanted("heat::u=ulp:4", Metric::L2, 1e-3);
  CHECK(own.name == "heat::u");
  CHECK(own.metric == Metric::Ulp);
  CHECK(own.tolerance == 4);
  CHECK_THROWS_AS(sk_tool::tune::parseWanted("u=l3", Metric::L2, 1), std::runtime_error);
  CHECK_THROWS_AS(sk_tool::tune::parseWanted("u=l2:-1", Metric::L2, 1), std::runtime_error);
}
