// SPDX-License-Identifier: MIT
//
// Promises: the programs that repeat a step compute what their checks ask for, in a loop, call by call and as plain loops; a loop
// of these runs in tiles; and a check finds a step too few, in blocks of a large grid as in all of a small one. The test program
// sets SK_LOOP_TILES to a small cache, so that small grids need tiles.
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "check.hpp"
#include "peers/openmp/all.hpp"
#include "problems.hpp"
#include "programs/all.hpp"
#include "programs/evolution.hpp"
#include "programs/loops.sk.hpp"

namespace race {
namespace {

struct Raced {
  const char* name;
  Problem (*problem)(int log2);
  Check (*check)(const Problem& problem);
  MakeOurs ours, other;
  std::unique_ptr<Task> (*openMp)(const Problem& problem);
};

const Raced raced[] = {
    {"heat loop", fieldProblem, heatLoopCheck, heatLoopOurs, heatLoopCalls, heatLoopOpenMp},
    {"gray-scott loop", reactionLoopProblem, reactionLoopCheck, reactionLoopOurs, reactionLoopCalls,
     reactionLoopOpenMp},
    {"wave loop", fieldProblem, waveLoopCheck, waveLoopOurs, waveLoopCalls, waveLoopOpenMp},
    {"chain of four", fieldProblem, chainCheck, chainOurs, chainInOneKernel, chainOpenMp},
    {"pipeline of four", fieldProblem, chainCheck, pipelineOurs, chainInOneKernel, chainOpenMp},
};

/// What is wrong after two runs, the second of which begins anew.
std::string faultAfterRuns(Task& task, const Check& check) {
  task.run(1);
  task.run(1);
  return faultOf(task.result(), check).value_or("");
}

TEST_CASE("programs that repeat a step give what is checked") {
  sk::Device native("native");
  for (const Raced& program : raced) {
    INFO(program.name);
    const Problem p = program.problem(15);
    const Check check = program.check(p);
    const std::unique_ptr<Task> loop = program.ours(native, {}, p), other = program.other(native, {}, p);
    CHECK(faultAfterRuns(*loop, check) == "");
    CHECK(faultAfterRuns(*other, check) == "");
    CHECK(loop->result() == other->result());
    CHECK(faultAfterRuns(*program.openMp(p), check) == "");
  }
}

TEST_CASE("fragment and compute programs that repeat a step give what is checked") {
  sk::Device gl("gl");
  for (const Raced& program : raced) {
    INFO(program.name);
    const Problem p = program.problem(10);
    const Check check = program.check(p);
    for (const sk::Target target : {sk::Target::Fragment, sk::Target::Compute}) {
      sk::CallOptions options;
      options.target = target;
      CHECK(faultAfterRuns(*program.ours(gl, options, p), check) == "");
      CHECK(faultAfterRuns(*program.other(gl, options, p), check) == "");
    }
  }
}

TEST_CASE("the loops that are raced run in tiles") {
  sk::Device device("native");
  auto u = device.stream<float>({128, 256}), v = device.stream<float>({128, 256});
  for (auto* stream : {&u, &v}) stream->fill(1);
  const auto planOf = [&](auto&& calls) { return device.record(calls).plan(); };
  CHECK_THAT(planOf([&] {
               loops::heat(0.2f, u, v);
               std::swap(u, v);
             }),
             Catch::Matchers::Contains("in tiles of"));
  CHECK_THAT(planOf([&] {
               loops::wave(0.2f, u, v, v);
               std::swap(u, v);
             }),
             Catch::Matchers::Contains("in tiles of"));
  CHECK_THAT(planOf([&] {
               loops::lift(u, u);
               loops::bend(u, u);
             }),
             Catch::Matchers::Contains("loops::lift, loops::bend: in tiles of"));
}

/// The mean of a cell and two beside it.
void smooth(const Lattice& now, Lattice& next, Edge edge) {
  const std::vector<double>& u = now.fields[0];
  forEachCell(now, edge,
              [&](const Cell& c) { next.fields[0][c.here] = (u[c.here] + u[c.east] + 2 * u[c.north]) / 4; });
}

TEST_CASE("blocks of a grid have the values that they have in all of it") {
  const Problem p = fieldProblem(16);
  for (const Edge edge : {Edge::Clamp, Edge::Zero, Edge::Wrap}) {
    const Evolution evolution{edge, 20,
                              [edge](const Lattice& now, Lattice& next) { smooth(now, next, edge); }};
    const Check blocks = evolutionCheck(p, evolution, 1e-12, 0);
    const Check all = evolutionCheck(p, evolution, 1e-12);
    CHECK(blocks.values.size() > 10000);
    // The whole grid is looked at in some places; those of them that are in blocks must agree.
    std::vector<double> whole(static_cast<std::size_t>(p.size()), -1);
    for (std::size_t i = 0; i < all.places.size(); ++i)
      whole[static_cast<std::size_t>(all.places[i])] = all.values[i];
    int both = 0;
    for (std::size_t i = 0; i < blocks.places.size(); ++i) {
      const double value = whole[static_cast<std::size_t>(blocks.places[i])];
      if (value < 0) continue;
      ++both;
      REQUIRE(std::fabs(value - blocks.values[i]) < 1e-12);
    }
    CHECK(both > 100);
  }
}

TEST_CASE("a check finds a step too few") {
  for (const int log2 : {12, 16}) {
    const Problem p = fieldProblem(log2);
    const auto after = [&](int steps) {
      return evolutionCheck(
          p, {Edge::Clamp, steps, [](const Lattice& now, Lattice& next) { smooth(now, next, Edge::Clamp); }},
          0x1p-18, 1 << 12);
    };
    const Check right = after(20), few = after(19);
    std::vector<float> result(static_cast<std::size_t>(p.size()));
    for (std::size_t i = 0; i < few.places.size(); ++i)
      result[static_cast<std::size_t>(few.places[i])] = static_cast<float>(few.values[i]);
    CHECK(faultOf(result, right).has_value());
    for (std::size_t i = 0; i < right.places.size(); ++i)
      result[static_cast<std::size_t>(right.places[i])] = static_cast<float>(right.values[i]);
    CHECK_FALSE(faultOf(result, right).has_value());
  }
}

}  // namespace
}  // namespace race
