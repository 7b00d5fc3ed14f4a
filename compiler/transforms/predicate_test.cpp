// SPDX-License-Identifier: MIT
//
// Promises: after predicate no control flow varies, and each lane computes what its element computes alone.
#include "transforms/predicate.hpp"

#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "analysis/validate_predicated.hpp"
#include "ir/clone_module.hpp"
#include "ir/kernel_maker.hpp"
#include "ir/print.hpp"
#include "ir/validate.hpp"
#include "transforms/lane_evaluator.hpp"
#include "transforms/random_kernel.hpp"

namespace skc {
namespace {

using namespace ir;
using Lanes = LaneEvaluator::Lanes;

struct Outcome {
  std::vector<std::int32_t> r;
  std::vector<LaneEvaluator::Value> pushed;
  bool operator==(const Outcome&) const = default;
};

/// A kernel of u, x, r and a sink, with a mask where it takes one; the elements from number `first` on.
Outcome run(const Module& module, std::int32_t u, const std::vector<std::int32_t>& x, std::size_t first, std::size_t count,
            bool inFull, const analysis::Uniformity* shapes) {
  LaneEvaluator evaluator(module, count, inFull, shapes);
  evaluator.firstIndex = static_cast<std::int32_t>(first);
  std::vector<Lanes> arguments(4, Lanes(count, {0}));
  arguments[0] = Lanes(count, {u});
  for (std::size_t i = 0; i < count; ++i) arguments[1][i] = {x[first + i]};
  const Kernel& kernel = module.kernels.front();
  if (entryMask(module, kernel)) arguments.emplace_back(count, LaneEvaluator::Value{1});
  const std::vector<Lanes> after = evaluator.run(kernel.entry, std::move(arguments));
  Outcome outcome{{}, std::move(evaluator.pushed)};
  for (const LaneEvaluator::Value& value : after[2]) outcome.r.push_back(value.front());
  return outcome;
}

Outcome oneByOne(const Module& module, std::int32_t u, const std::vector<std::int32_t>& x, bool inFull) {
  Outcome all;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Outcome one = run(module, u, x, i, 1, inFull, nullptr);
    all.r.push_back(one.r.front());
    all.pushed.push_back(one.pushed.front());
  }
  return all;
}

void checkLanes(const Module& module) {
  INFO(print(module));
  REQUIRE(validate(module, Stage::Specialized) == "");
  Module lanes = clone(module);
  predicate(lanes);
  INFO(print(lanes));
  REQUIRE(analysis::validatePredicated(lanes) == "");
  const analysis::Uniformity shapes(lanes, lanes.kernels.front());
  const std::vector<std::int32_t> x = {0, 1, -1, 2, 7, 3, 5, -4};
  for (const std::int32_t u : {0, 1, 3}) {
    const Outcome expected = oneByOne(module, u, x, false);
    CHECK(oneByOne(lanes, u, x, true) == expected);
    CHECK(run(lanes, u, x, 0, x.size(), true, &shapes) == expected);
  }
}

TEST_CASE("each lane computes what its element computes alone") {
  for (std::uint32_t seed = 0; seed < 400; ++seed) {
    INFO("seed " << seed);
    checkLanes(randomKernel(seed));
  }
}

}  // namespace
}  // namespace skc
